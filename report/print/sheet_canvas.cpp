#include "report/print/sheet_canvas.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/errors.h"

namespace glidelab::report {
namespace {

constexpr double kPointsPerM = 72.0 / 0.0254;  // PDF's unit
constexpr double kMillimetresPerM = 1e3;       // the unit that the SVG says it is in

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

struct SheetCanvas::Cairo {
  std::string bytes;  // of a page, as Cairo writes them
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
  /// Ends the drawing and says whether all of it went well.
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

SheetCanvas SheetCanvas::picture(double width_m, double height_m, double pixels_per_m) {
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

SheetPicture SheetCanvas::finish_picture() {
  cairo_surface_flush(cairo_->surface);
  SheetPicture picture{
      cairo_image_surface_get_width(cairo_->surface), cairo_image_surface_get_height(cairo_->surface), {}};
  const unsigned char* pixels = cairo_image_surface_get_data(cairo_->surface);
  const int stride = cairo_image_surface_get_stride(cairo_->surface);
  for (int row = 0; pixels != nullptr && row < picture.height; ++row) {
    for (int column = 0; column < picture.width; ++column) {
      constexpr int kBytesPerPixel = 4;  // RGB24, of which all three are equal
      picture.grey.push_back(pixels[row * stride + column * kBytesPerPixel + 1]);
    }
  }
  cairo_->finish();
  return picture;
}

}  // namespace glidelab::report
