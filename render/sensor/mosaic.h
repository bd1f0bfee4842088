/// A colour sensor that sees a scene without colours: Bayer mosaic and bilinear demosaicing to grey.
///
/// Rows of red, green, red, … and green, blue, green, … (RGGB, the first pixel red). White balance divides each pixel
/// by its colour's response to white light; the two colours that a pixel lacks are the means of the nearest pixels that
/// have them (2 or 4); grey is 0.299 R + 0.587 G + 0.114 B (ITU-R BT.601, as video decoders have it). All of that is
/// linear, so that it is one of four masks of 3 x 3 weights, by the pixel's place in the mosaic.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "render/image/float_picture.h"

namespace glidelab::render {

/// Place of a pixel in the 2 x 2 mosaic.
inline std::size_t mosaic_place(int x, int y) {
  return static_cast<std::size_t>(2 * (y & 1) + (x & 1));
}

/// Answers of the pixels to white light, by place.
std::array<float, 4> mosaic_response(const std::array<double, 3>& red_green_blue);

/// Grey of the pixels of `inner` (in coordinates of the whole image of width x height), row by row, from the codes of
/// `outer`, which holds all of `inner` and its neighbours: one pixel more on each side that is not the image's edge.
/// At an edge the image is mirrored about its last pixel, which keeps the colours in place. Codes count from
/// `offset_dn`, and the result too.
FloatPicture demosaic(std::span<const std::uint16_t> codes, const PixelRect& outer, const PixelRect& inner, int width,
                      int height, const std::array<float, 4>& response, float offset_dn);

/// `inner` with the neighbours that demosaic() needs.
PixelRect with_neighbours(const PixelRect& inner, int width, int height);

}  // namespace glidelab::render
