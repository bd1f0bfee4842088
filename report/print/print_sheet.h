/// Sheets to print to scale: the chessboard for the calibration, and markers to cut out; the only code that uses Cairo.
/// All lengths are in metres.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::report {

enum class SheetFormat { pdf, svg };

struct SheetImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> grey;  ///< row by row, 0 black to 255 white
};

/// A sheet of paper to draw on to scale.
///
/// Metres from the sheet's top left corner, x to the right, y down. The drawing becomes a PDF or SVG page of that size,
/// or grey pixels (for viewing and tests).
class SheetCanvas {
 public:
  /// A white sheet that becomes a file.
  static SheetCanvas page(double width_m, double height_m, SheetFormat format);
  /// The same as pixels; width and height are rounded to whole pixels.
  static SheetCanvas image(double width_m, double height_m, double pixels_per_m);
  SheetCanvas(SheetCanvas&&) noexcept;
  ~SheetCanvas();

  /// 0 is black, 1 white.
  void rectangle(double x_m, double y_m, double width_m, double height_m, double grey = 0.0);
  void disc(double x_m, double y_m, double radius_m, double grey = 0.0);
  void line(double x1_m, double y1_m, double x2_m, double y2_m, double width_m, double grey = 0.0);
  /// The text's baseline starts at (x, y); `size_m` is the font's height.
  void text(double x_m, double y_m, double size_m, std::string_view text);

  /// The bytes of a page()'s file. EnvironmentError if Cairo fails. Nothing may be drawn afterwards.
  std::string finish_page();
  /// The pixels of an image(); likewise.
  SheetImage finish_image();

 private:
  struct Cairo;
  explicit SheetCanvas(std::unique_ptr<Cairo> cairo);
  std::unique_ptr<Cairo> cairo_;
};

/// With the long side horizontal.
struct Paper {
  std::string name;
  double width_m = 0.0;
  double height_m = 0.0;
};

/// a4, a3 (ISO 216) and letter (ANSI A).
std::span<const Paper> papers();

/// InputError (of `--paper`) if there is none of this name.
const Paper& paper_of(const std::string& name);

/// The chessboard for the calibration.
///
/// The board's long row of squares lies along the paper's long side. Its left corner squares are black, its right ones
/// white, so that an image shows its orientation (the order of core/pictures/board/chessboard.h): the longer row of
/// inner corners is odd, the shorter one even. White paper surrounds it, and below it a line of known length shows
/// whether the printer kept the scale.
struct BoardSheet {
  Paper paper;
  int columns = 9;  ///< inner corners of the longer row, odd
  int rows = 6;     ///< even
  double square_m = 0.025;
};

/// The largest square for this many inner corners that fits on the paper with its margins, in whole millimetres; 0 if
/// not even 1 mm fits.
double largest_square_m(const Paper& paper, int columns, int rows);

/// InputError (of `--corners`, `--square-mm`) if the board's two ends would look alike, if it does not fit, or if its
/// squares are finer than 1 mm, which printers do not draw sharply.
void validate(const BoardSheet& sheet);
/// The text below the board: how many squares in a row to measure. A row shows the board's edge at its black end, and
/// no row has two black ends.
std::string measure_text(const BoardSheet& sheet);
/// The file's bytes, and the same as pixels (for tests). InputError as in validate(); EnvironmentError if Cairo fails.
std::string board_page(const BoardSheet& sheet, SheetFormat format);
SheetImage board_image(const BoardSheet& sheet, double pixels_per_m);

/// Discs of these diameters, in each row white ones on black and black ones on white, on squares of twice the size.
struct MarkerSheet {
  Paper paper;
  std::vector<double> diameters_m;
};

/// InputError (of `--marker-mm`) if they do not fit, or if one is finer than 1 mm.
void validate(const MarkerSheet& sheet);
/// As board_page() and board_image().
std::string marker_page(const MarkerSheet& sheet, SheetFormat format);
SheetImage marker_image(const MarkerSheet& sheet, double pixels_per_m);

}  // namespace glidelab::report
