#include "client/picture/canvas.h"

#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/file/output_file.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

// Pixels of a PNG per point.
constexpr double kPixelsPerPoint = 2;
constexpr double kArrowHead = 3.2;

}  // namespace

struct Canvas::Page {
  std::string path;
  double width = 0;
  double height = 0;
  bool svg = false;
  cairo_surface_t* surface = nullptr;
  cairo_t* cairo = nullptr;

  ~Page() {
    if (cairo != nullptr) cairo_destroy(cairo);
    if (surface != nullptr) cairo_surface_destroy(surface);
  }
};

Colour ColourOf(std::int64_t number) {
  constexpr std::array<Colour, 6> kColours = {kBlue, kRed, kGreen, kOrange, kPurple, kSky};
  return kColours[static_cast<std::size_t>(number < 0 ? 0 : number) % kColours.size()];
}

Canvas::Canvas(std::unique_ptr<Page> page) : page_(std::move(page)) {}
Canvas::Canvas(Canvas&&) noexcept = default;
Canvas& Canvas::operator=(Canvas&&) noexcept = default;
Canvas::~Canvas() = default;

absl::StatusOr<Canvas> Canvas::Create(const std::string& path, double width, double height) {
  auto page = std::make_unique<Page>();
  page->path = path;
  page->width = width;
  page->height = height;
  page->svg = absl::EndsWithIgnoreCase(path, ".svg");
  if (!page->svg && !absl::EndsWithIgnoreCase(path, ".png")) {
    return absl::InvalidArgumentError(absl::StrCat(path, " must end in .svg or .png"));
  }
  HOMING_RETURN_IF_ERROR(CheckWritable(path));
  if (page->svg) {
    page->surface = cairo_svg_surface_create(path.c_str(), width, height);
  } else {
    page->surface = cairo_image_surface_create(
        CAIRO_FORMAT_RGB24, static_cast<int>(std::lround(width * kPixelsPerPoint)),
        static_cast<int>(std::lround(height * kPixelsPerPoint)));
  }
  page->cairo = cairo_create(page->surface);
  if (cairo_status(page->cairo) != CAIRO_STATUS_SUCCESS) {
    return absl::UnknownError(absl::StrCat("cannot write ", path, ": ",
                                           cairo_status_to_string(cairo_status(page->cairo))));
  }
  if (!page->svg) cairo_scale(page->cairo, kPixelsPerPoint, kPixelsPerPoint);
  Canvas canvas(std::move(page));
  canvas.Fill({0, 0, width, height}, {1, 1, 1, 1});
  return canvas;
}

double Canvas::width() const { return page_->width; }
double Canvas::height() const { return page_->height; }

void Canvas::SetColour(Colour colour) {
  cairo_set_source_rgba(page_->cairo, colour.red, colour.green, colour.blue, colour.alpha);
}

void Canvas::Line(Point from, Point to, Colour colour, double thickness, bool dashed) {
  constexpr std::array<double, 2> kDashes = {4, 3};
  SetColour(colour);
  cairo_set_line_width(page_->cairo, thickness);
  cairo_set_dash(page_->cairo, kDashes.data(), dashed ? 2 : 0, 0);
  cairo_move_to(page_->cairo, from.x, from.y);
  cairo_line_to(page_->cairo, to.x, to.y);
  cairo_stroke(page_->cairo);
  cairo_set_dash(page_->cairo, kDashes.data(), 0, 0);
}

void Canvas::Polyline(const std::vector<Point>& points, Colour colour, double thickness) {
  SetColour(colour);
  cairo_set_line_width(page_->cairo, thickness);
  cairo_set_line_join(page_->cairo, CAIRO_LINE_JOIN_ROUND);
  cairo_new_path(page_->cairo);
  for (const Point& point : points) cairo_line_to(page_->cairo, point.x, point.y);
  cairo_stroke(page_->cairo);
}

void Canvas::Arrow(Point from, Point to, Colour colour, double thickness) {
  const double angle = std::atan2(to.y - from.y, to.x - from.x);
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const double head = std::min(kArrowHead, 0.6 * length);
  Line(from, to, colour, thickness);
  for (const double side : {-0.45, 0.45}) {
    const Point end{to.x - head * std::cos(angle + side), to.y - head * std::sin(angle + side)};
    Line(to, end, colour, thickness);
  }
}

void Canvas::Fill(const Box& box, Colour colour) {
  SetColour(colour);
  cairo_rectangle(page_->cairo, box.x, box.y, box.width, box.height);
  cairo_fill(page_->cairo);
}

void Canvas::Outline(const Box& box, Colour colour, double thickness) {
  SetColour(colour);
  cairo_set_line_width(page_->cairo, thickness);
  cairo_rectangle(page_->cairo, box.x, box.y, box.width, box.height);
  cairo_stroke(page_->cairo);
}

void Canvas::Disc(Point center, double radius, Colour colour) {
  SetColour(colour);
  cairo_arc(page_->cairo, center.x, center.y, radius, 0, 2 * std::numbers::pi);
  cairo_fill(page_->cairo);
}

void Canvas::Ring(Point center, double radius, Colour colour, double thickness) {
  SetColour(colour);
  cairo_set_line_width(page_->cairo, thickness);
  cairo_new_sub_path(page_->cairo);
  cairo_arc(page_->cairo, center.x, center.y, radius, 0, 2 * std::numbers::pi);
  cairo_stroke(page_->cairo);
}

void Canvas::Text(Point at, const std::string& text, const TextStyle& style) {
  cairo_select_font_face(page_->cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(page_->cairo, style.size);
  cairo_text_extents_t extents;
  cairo_text_extents(page_->cairo, text.c_str(), &extents);
  const double share =
      style.align == Align::kLeft ? 0.0 : (style.align == Align::kCenter ? 0.5 : 1.0);
  SetColour(style.colour);
  cairo_save(page_->cairo);
  cairo_translate(page_->cairo, at.x, at.y);
  cairo_rotate(page_->cairo, style.angle);
  cairo_move_to(page_->cairo, -share * extents.x_advance, 0);
  cairo_show_text(page_->cairo, text.c_str());
  cairo_restore(page_->cairo);
}

void Canvas::Image(const Box& box, const GrayImage& image, double strength) {
  const int stride = cairo_format_stride_for_width(CAIRO_FORMAT_RGB24, image.width);
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  const auto row = static_cast<std::size_t>(stride);
  std::vector<unsigned char> pixels(row * height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const auto gray = static_cast<unsigned char>(image.pixels[y * width + x]);
      const auto mixed = static_cast<unsigned char>(255 - strength * (255 - gray));
      std::fill_n(&pixels[y * row + 4 * x], 3, mixed);
    }
  }
  cairo_surface_t* surface = cairo_image_surface_create_for_data(pixels.data(), CAIRO_FORMAT_RGB24,
                                                                 image.width, image.height, stride);
  cairo_save(page_->cairo);
  cairo_translate(page_->cairo, box.x, box.y);
  cairo_scale(page_->cairo, box.width / image.width, box.height / image.height);
  cairo_set_source_surface(page_->cairo, surface, 0, 0);
  // Without padding the outermost pixels fade out.
  cairo_pattern_set_extend(cairo_get_source(page_->cairo), CAIRO_EXTEND_PAD);
  cairo_rectangle(page_->cairo, 0, 0, image.width, image.height);
  cairo_fill(page_->cairo);
  cairo_restore(page_->cairo);
  // An SVG surface keeps a copy of the image only while the image's surface lives.
  cairo_surface_flush(page_->surface);
  cairo_surface_finish(surface);
  cairo_surface_destroy(surface);
}

void Canvas::Clip(const Box& box) {
  cairo_save(page_->cairo);
  cairo_rectangle(page_->cairo, box.x, box.y, box.width, box.height);
  cairo_clip(page_->cairo);
}

void Canvas::Unclip() { cairo_restore(page_->cairo); }

absl::Status Canvas::Finish() {
  cairo_status_t status = cairo_status(page_->cairo);
  if (status == CAIRO_STATUS_SUCCESS && !page_->svg) {
    status = cairo_surface_write_to_png(page_->surface, page_->path.c_str());
  }
  if (status == CAIRO_STATUS_SUCCESS && page_->svg) {
    cairo_surface_finish(page_->surface);
    status = cairo_surface_status(page_->surface);
  }
  if (status == CAIRO_STATUS_SUCCESS) return absl::OkStatus();
  return absl::UnknownError(
      absl::StrCat("cannot write ", page_->path, ": ", cairo_status_to_string(status)));
}

}  // namespace homing::client
