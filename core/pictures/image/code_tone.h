/// From an image's codes to light and back: straight, or by the curve of video and photographs (IEC 61966-2-1, sRGB).
#pragma once

namespace glidelab::core {

enum class ToneCurve { linear, srgb };

/// Light of a code and back, both as shares of the largest; beyond 0 and 1 clipped, as a camera does.
double light_of_code(ToneCurve tone, double code);
double code_of_light(ToneCurve tone, double light);

}  // namespace glidelab::core
