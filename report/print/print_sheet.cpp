#include "report/print/print_sheet.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/errors.h"

namespace glidelab::report {
namespace {

constexpr double kPointsPerM = 72.0 / 0.0254;  // PDF's unit
constexpr double kMillimetresPerM = 1e3;       // the unit stated in the SVG

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

struct SheetCanvas::Cairo {
  std::string bytes;  // of a page, as written by Cairo
  cairo_surface_t* surface = nullptr;
  cairo_t* context = nullptr;

  Cairo() = default;
  Cairo(const Cairo&) = delete;
  Cairo& operator=(const Cairo&) = delete;
  ~Cairo() {
    cairo_destroy(context);
    cairo_surface_destroy(surface);
  }
  void begin(double units_per_m) {
    context = cairo_create(surface);
    cairo_scale(context, units_per_m, units_per_m);
    cairo_set_source_rgb(context, 1.0, 1.0, 1.0);
    cairo_paint(context);
  }
  /// Ends the drawing and reports any failure.
  void finish() {
    const cairo_status_t drawn = cairo_status(context);
    cairo_surface_finish(surface);
    const cairo_status_t status = drawn == CAIRO_STATUS_SUCCESS ? cairo_surface_status(surface) : drawn;
    if (status != CAIRO_STATUS_SUCCESS) {
      throw base::EnvironmentError(fmt::format("a sheet cannot be drawn: {}", cairo_status_to_string(status)));
    }
  }
  void grey(double value) const { cairo_set_source_rgb(context, value, value, value); }
};

SheetCanvas::SheetCanvas(std::unique_ptr<Cairo> cairo) : cairo_(std::move(cairo)) {}
SheetCanvas::SheetCanvas(SheetCanvas&&) noexcept = default;
SheetCanvas::~SheetCanvas() = default;

SheetCanvas SheetCanvas::page(double width_m, double height_m, SheetFormat format) {
  auto cairo = std::make_unique<Cairo>();
  if (format == SheetFormat::pdf) {
    cairo->surface =
        cairo_pdf_surface_create_for_stream(append, &cairo->bytes, width_m * kPointsPerM, height_m * kPointsPerM);
    cairo->begin(kPointsPerM);
  } else {
    cairo->surface = cairo_svg_surface_create_for_stream(append, &cairo->bytes, width_m * kMillimetresPerM,
                                                         height_m * kMillimetresPerM);
    cairo_svg_surface_set_document_unit(cairo->surface, CAIRO_SVG_UNIT_MM);
    cairo->begin(kMillimetresPerM);
  }
  return SheetCanvas(std::move(cairo));
}

SheetCanvas SheetCanvas::image(double width_m, double height_m, double pixels_per_m) {
  auto cairo = std::make_unique<Cairo>();
  const auto pixels = [&](double length_m) { return static_cast<int>(std::lround(length_m * pixels_per_m)); };
  cairo->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(width_m), pixels(height_m));
  cairo->begin(pixels_per_m);
  return SheetCanvas(std::move(cairo));
}

void SheetCanvas::rectangle(double x_m, double y_m, double width_m, double height_m, double grey) {
  cairo_->grey(grey);
  cairo_rectangle(cairo_->context, x_m, y_m, width_m, height_m);
  cairo_fill(cairo_->context);
}

void SheetCanvas::disc(double x_m, double y_m, double radius_m, double grey) {
  cairo_->grey(grey);
  cairo_arc(cairo_->context, x_m, y_m, radius_m, 0.0, 2.0 * std::numbers::pi);
  cairo_fill(cairo_->context);
}

void SheetCanvas::line(double x1_m, double y1_m, double x2_m, double y2_m, double width_m, double grey) {
  cairo_->grey(grey);
  cairo_set_line_width(cairo_->context, width_m);
  cairo_move_to(cairo_->context, x1_m, y1_m);
  cairo_line_to(cairo_->context, x2_m, y2_m);
  cairo_stroke(cairo_->context);
}

void SheetCanvas::text(double x_m, double y_m, double size_m, std::string_view text) {
  cairo_->grey(0.0);
  cairo_select_font_face(cairo_->context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo_->context, size_m);
  cairo_move_to(cairo_->context, x_m, y_m);
  cairo_show_text(cairo_->context, std::string(text).c_str());
}

std::string SheetCanvas::finish_page() {
  cairo_show_page(cairo_->context);
  cairo_->finish();
  return std::move(cairo_->bytes);
}

SheetImage SheetCanvas::finish_image() {
  cairo_surface_flush(cairo_->surface);
  SheetImage image{cairo_image_surface_get_width(cairo_->surface), cairo_image_surface_get_height(cairo_->surface), {}};
  const unsigned char* pixels = cairo_image_surface_get_data(cairo_->surface);
  const int stride = cairo_image_surface_get_stride(cairo_->surface);
  for (int row = 0; pixels != nullptr && row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      constexpr int kBytesPerPixel = 4;  // RGB24, with equal channels
      image.grey.push_back(pixels[row * stride + column * kBytesPerPixel + 1]);
    }
  }
  cairo_->finish();
  return image;
}

namespace {

constexpr double kMargin = 0.010;      // m; white around everything, more than printers need
constexpr double kFoot = 0.025;        // m; below the board or the markers: the ruler, two lines of text, the margin
constexpr double kTextSize = 0.0032;   // m; 9 point
constexpr double kRuler = 0.100;       // m
constexpr double kLine = 0.0003;       // m
constexpr double kGap = 0.004;         // m; between markers
constexpr double kLabel = 0.018;       // m; left of a row of markers
constexpr double kRounding = 1e-9;     // m; sums of lengths that fit exactly may exceed the limit by this
constexpr double kMillimetre = 0.001;  // m
constexpr double kFinest = 0.001;      // m; a square or disc of 12 dots on a printer with 300 dots per inch

const std::array<Paper, 3> kPapers = {
    Paper{"a4", 0.297, 0.210}, {"a3", 0.420, 0.297}, {"letter", 11.0 * 0.0254, 8.5 * 0.0254}};

[[noreturn]] void fail(std::string key, std::string found, std::string expected) {
  throw base::InputError(base::Issue{"", 0, std::move(key), std::move(found), std::move(expected)});
}

std::string millimetres(double length_m) {
  return fmt::format("{:.6g} mm", length_m / kMillimetre);
}

/// The line to measure, and two lines of text beside it.
void draw_foot(SheetCanvas& canvas, const Paper& paper, const std::string& first, const std::string& second) {
  const double y = paper.height_m - kMargin;
  for (int tick = 0; tick <= 10; ++tick) {
    const double x = kMargin + 0.1 * kRuler * tick;
    canvas.line(x, y - (tick % 10 == 0 ? 0.006 : tick == 5 ? 0.004 : 0.003), x, y, kLine);
  }
  canvas.line(kMargin, y, kMargin + kRuler, y, kLine);
  canvas.text(kMargin + 0.012, y - 0.0055, kTextSize,
              fmt::format("This line is {} long: print at 100 %", millimetres(kRuler)));
  canvas.text(kMargin + kRuler + 0.008, y - 0.005, kTextSize, first);
  canvas.text(kMargin + kRuler + 0.008, y, kTextSize, second);
}

double room_for_square(const Paper& paper, int columns, int rows) {
  return std::min((paper.width_m - 2.0 * kMargin) / (columns + 1), (paper.height_m - kMargin - kFoot) / (rows + 1));
}

void draw(SheetCanvas& canvas, const BoardSheet& sheet) {
  const double width = (sheet.columns + 1) * sheet.square_m;
  const double height = (sheet.rows + 1) * sheet.square_m;
  const double left = 0.5 * (sheet.paper.width_m - width);
  const double top = kMargin + 0.5 * (sheet.paper.height_m - kMargin - kFoot - height);
  for (int j = 0; j <= sheet.rows; ++j) {
    for (int i = j % 2; i <= sheet.columns; i += 2) {  // black, from the corner (0, 0) on
      canvas.rectangle(left + i * sheet.square_m, top + j * sheet.square_m, sheet.square_m, sheet.square_m);
    }
  }
  draw_foot(canvas, sheet.paper,
            fmt::format("inner_corners = [{}, {}]   square_m = {:.6g}", sheet.columns, sheet.rows, sheet.square_m),
            measure_text(sheet));
}

/// Side of the square on which a marker of this diameter is printed.
double tile(double diameter_m) {
  return 2.0 * diameter_m;
}

double height_of_rows(const std::vector<double>& diameters_m) {
  double height = 0.0;
  for (const double diameter : diameters_m) height += tile(diameter) + kGap;
  return height - kGap;
}

void draw(SheetCanvas& canvas, const MarkerSheet& sheet) {
  double top = kMargin;
  for (const double diameter : sheet.diameters_m) {
    const double side = tile(diameter);
    const double room = sheet.paper.width_m - 2.0 * kMargin - kLabel;
    const int count = static_cast<int>(std::floor((room + kGap + kRounding) / (side + kGap)));
    canvas.text(kMargin, top + 0.5 * (side + kTextSize), kTextSize, millimetres(diameter));
    for (int k = 0; k < count; ++k) {
      const double left = kMargin + kLabel + k * (side + kGap);
      const bool white_on_black = k % 2 == 0;
      if (white_on_black) {
        canvas.rectangle(left, top, side, side);
      } else {  // a frame to cut along
        canvas.rectangle(left, top, side, side, 0.6);
        canvas.rectangle(left + kLine, top + kLine, side - 2.0 * kLine, side - 2.0 * kLine, 1.0);
      }
      canvas.disc(left + 0.5 * side, top + 0.5 * side, 0.5 * diameter, white_on_black ? 1.0 : 0.0);
    }
    top += side + kGap;
  }
  draw_foot(canvas, sheet.paper,
            "diameter_m is that of the disc. Choose one that contrasts with everything near its path;",
            "for a black disc say color = \"#101010\" in [marker].");
}

template <class Sheet>
std::string page_of(const Sheet& sheet, SheetFormat format) {
  validate(sheet);
  SheetCanvas canvas = SheetCanvas::page(sheet.paper.width_m, sheet.paper.height_m, format);
  draw(canvas, sheet);
  return canvas.finish_page();
}

template <class Sheet>
SheetImage image_of(const Sheet& sheet, double pixels_per_m) {
  validate(sheet);
  SheetCanvas canvas = SheetCanvas::image(sheet.paper.width_m, sheet.paper.height_m, pixels_per_m);
  draw(canvas, sheet);
  return canvas.finish_image();
}

}  // namespace

std::span<const Paper> papers() {
  return kPapers;
}

const Paper& paper_of(const std::string& name) {
  const auto found =
      std::find_if(kPapers.begin(), kPapers.end(), [&](const Paper& paper) { return paper.name == name; });
  if (found == kPapers.end()) fail("--paper", name, "a4, a3 or letter");
  return *found;
}

double largest_square_m(const Paper& paper, int columns, int rows) {
  return std::floor((room_for_square(paper, columns, rows) + kRounding) / kMillimetre) * kMillimetre;
}

void validate(const BoardSheet& sheet) {
  if (sheet.columns <= sheet.rows || sheet.columns % 2 == 0 || sheet.rows % 2 == 1 || sheet.rows < 2) {
    fail("--corners", fmt::format("{}x{}", sheet.columns, sheet.rows),
         "the longer row odd, the shorter one even, such as 9x6: otherwise the board's two ends look alike, and an "
         "image does not show its orientation");
  }
  const double largest = room_for_square(sheet.paper, sheet.columns, sheet.rows);
  if (!(sheet.square_m >= kFinest - kRounding) || sheet.square_m > largest + kRounding) {
    fail("--square-mm", fmt::format("{:.6g}", sheet.square_m / kMillimetre),
         fmt::format(
             "at least {:g}, which a printer draws sharply, and at most {:.4g}, so that {} x {} squares and their "
             "margin fit on {}",
             kFinest / kMillimetre, largest / kMillimetre, sheet.columns + 1, sheet.rows + 1, sheet.paper.name));
  }
}

void validate(const MarkerSheet& sheet) {
  const double room_down = sheet.paper.height_m - kMargin - kFoot;
  const double room_across = sheet.paper.width_m - 2.0 * kMargin - kLabel;
  if (sheet.diameters_m.empty()) fail("--marker-mm", "nothing", "one or more diameters");
  for (const double diameter : sheet.diameters_m) {
    // One of each kind side by side.
    if (diameter >= kFinest - kRounding && 2.0 * tile(diameter) + kGap <= room_across + kRounding) continue;
    fail("--marker-mm", fmt::format("{:.6g}", diameter / kMillimetre),
         fmt::format("at least {:g}, which a printer draws sharply, and at most {:.4g} on {}", kFinest / kMillimetre,
                     0.25 * (room_across - kGap) / kMillimetre, sheet.paper.name));
  }
  if (height_of_rows(sheet.diameters_m) > room_down + kRounding) {
    fail("--marker-mm", fmt::format("rows of {} in all", millimetres(height_of_rows(sheet.diameters_m))),
         fmt::format("at most {}, twice the diameters with gaps of {}, on {}", millimetres(room_down),
                     millimetres(kGap), sheet.paper.name));
  }
}

std::string measure_text(const BoardSheet& sheet) {
  return fmt::format("X runs to the right. Measure {} squares ({}) and correct square_m.", sheet.columns,
                     millimetres(sheet.columns * sheet.square_m));
}

std::string board_page(const BoardSheet& sheet, SheetFormat format) {
  return page_of(sheet, format);
}
SheetImage board_image(const BoardSheet& sheet, double pixels_per_m) {
  return image_of(sheet, pixels_per_m);
}
std::string marker_page(const MarkerSheet& sheet, SheetFormat format) {
  return page_of(sheet, format);
}
SheetImage marker_image(const MarkerSheet& sheet, double pixels_per_m) {
  return image_of(sheet, pixels_per_m);
}

}  // namespace glidelab::report
