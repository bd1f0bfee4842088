/// Sheets to print to scale: the chessboard for the calibration, and markers to cut out; the only place that knows of
/// Cairo. All lengths are in metres.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
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

/// A sheet of paper to draw on to scale.
///
/// Metres from the sheet's top left corner, x to the right, y down. What is drawn comes out as a PDF or SVG page of
/// that size, or as grey pixels (to look at, and for tests).
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

/// With the long side across.
struct Paper {
  std::string name;
  double width_m = 0.0;
  double height_m = 0.0;
};

/// a4, a3 (ISO 216) and letter (ANSI A).
std::span<const Paper> papers();

/// InputError (of `--paper`) where there is none of this name.
const Paper& paper_of(const std::string& name);

/// The chessboard for the calibration.
///
/// The board's long row of squares lies along the paper's long side. Its left corner squares are black, its right ones
/// white, so that an image tells which way it lies (the order of core/pictures/board/chessboard.h): the longer row of
/// inner corners is odd, the shorter one even. Around it stays white paper, and below it a line of known length that
/// shows whether the printer kept the scale.
struct BoardSheet {
  Paper paper;
  int columns = 9;  ///< inner corners of the longer row, odd
  int rows = 6;     ///< even
  double square_m = 0.025;
};

/// The largest square for this many inner corners that the paper holds with its margins, in whole millimetres; 0 where
/// not even one of 1 mm does.
double largest_square_m(const Paper& paper, int columns, int rows);

/// InputError (of `--corners`, `--square-mm`) where the board's two ends would look alike, it does not fit, or its
/// squares are finer than 1 mm, which printers do not draw sharply.
void validate(const BoardSheet& sheet);
/// What the sheet says below the board: how many squares in a row to measure. At its black ends a row shows the
/// board's edge, and no row has two.
std::string measure_text(const BoardSheet& sheet);
/// The file's bytes, and the same as pixels (for tests). InputError as validate() has it; EnvironmentError if Cairo
/// fails.
std::string board_page(const BoardSheet& sheet, SheetFormat format);
SheetPicture board_picture(const BoardSheet& sheet, double pixels_per_m);

/// Discs of these diameters, in each row white ones on black and black ones on white, on squares of twice the size.
struct MarkerSheet {
  Paper paper;
  std::vector<double> diameters_m;
};

/// InputError (of `--marker-mm`) where they do not fit, or one is finer than 1 mm.
void validate(const MarkerSheet& sheet);
/// As board_page() and board_picture().
std::string marker_page(const MarkerSheet& sheet, SheetFormat format);
SheetPicture marker_picture(const MarkerSheet& sheet, double pixels_per_m);

}  // namespace glidelab::report
