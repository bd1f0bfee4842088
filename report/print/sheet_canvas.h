/// A sheet of paper to draw on to scale; the only place that knows of Cairo.
///
/// Metres from the sheet's top left corner, x to the right, y down. What is drawn comes out as a PDF or SVG page of
/// that size, or as grey pixels (to look at, and for tests).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::report {

enum class SheetFormat { pdf, svg };

struct SheetPicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> grey;  ///< row by row, 0 black to 255 white
};

class SheetCanvas {
 public:
  /// White paper that becomes a file.
  static SheetCanvas page(double width_m, double height_m, SheetFormat format);
  /// The same as pixels; width and height are rounded to whole ones.
  static SheetCanvas picture(double width_m, double height_m, double pixels_per_m);
  SheetCanvas(SheetCanvas&&) noexcept;
  ~SheetCanvas();

  /// 0 is black, 1 white.
  void rectangle(double x_m, double y_m, double width_m, double height_m, double grey = 0.0);
  void disc(double x_m, double y_m, double radius_m, double grey = 0.0);
  void line(double x1_m, double y1_m, double x2_m, double y2_m, double width_m, double grey = 0.0);
  /// The text's baseline starts at (x, y); `size_m` is the font's height.
  void text(double x_m, double y_m, double size_m, std::string_view text);

  /// The bytes of a page()'s file. EnvironmentError if Cairo fails. Nothing may be drawn any more.
  std::string finish_page();
  /// The pixels of a picture(); likewise.
  SheetPicture finish_picture();

 private:
  struct Cairo;
  explicit SheetCanvas(std::unique_ptr<Cairo> cairo);
  std::unique_ptr<Cairo> cairo_;
};

}  // namespace glidelab::report
