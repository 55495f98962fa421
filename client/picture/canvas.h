// A page to draw on: SVG or PNG by the file's ending. Uses cairo.
#ifndef CLIENT_PICTURE_CANVAS_H_
#define CLIENT_PICTURE_CANVAS_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace homing::client {

// 0..1.
struct Colour {
  double red = 0;
  double green = 0;
  double blue = 0;
  double alpha = 1;
};

// Colours that colour-blind people can distinguish (palette of Okabe and Ito).
inline constexpr Colour kBlack{0.13, 0.13, 0.13, 1};
inline constexpr Colour kGray{0.55, 0.55, 0.55, 1};
inline constexpr Colour kPale{0.88, 0.88, 0.88, 1};
inline constexpr Colour kBlue{0.00, 0.45, 0.70, 1};
inline constexpr Colour kGreen{0.00, 0.62, 0.45, 1};
inline constexpr Colour kRed{0.84, 0.37, 0.00, 1};
inline constexpr Colour kOrange{0.90, 0.62, 0.00, 1};
inline constexpr Colour kSky{0.34, 0.71, 0.91, 1};
inline constexpr Colour kPurple{0.80, 0.47, 0.65, 1};

inline constexpr Colour WithAlpha(Colour colour, double alpha) {
  colour.alpha = alpha;
  return colour;
}
// A colour for each landmark number.
Colour ColourOf(std::int64_t number);

struct Point {
  double x = 0;
  double y = 0;
};

struct Box {
  double x = 0;
  double y = 0;
  double width = 0;
  double height = 0;
};

enum class Align { kLeft, kCenter, kRight };

struct TextStyle {
  double size = 11;
  Align align = Align::kLeft;
  Colour colour = kBlack;
  bool bold = false;
  // Radians, clockwise.
  double angle = 0;
};

// 8-bit grey picture, row-major.
struct GrayImage {
  int width = 0;
  int height = 0;
  std::string pixels;
};

// Units: points from the top left; y down. Not thread-safe.
class Canvas {
 public:
  // A white canvas. INVALID_ARGUMENT: an ending other than .svg or .png.
  static absl::StatusOr<Canvas> Create(const std::string& path, double width, double height);
  Canvas(Canvas&&) noexcept;
  Canvas& operator=(Canvas&&) noexcept;
  ~Canvas();

  double width() const;
  double height() const;

  void Line(Point from, Point to, Colour colour, double thickness = 1, bool dashed = false);
  void Polyline(const std::vector<Point>& points, Colour colour, double thickness = 1);
  void Arrow(Point from, Point to, Colour colour, double thickness = 1);
  void Fill(const Box& box, Colour colour);
  void Outline(const Box& box, Colour colour, double thickness = 1);
  void Disc(Point center, double radius, Colour colour);
  void Ring(Point center, double radius, Colour colour, double thickness = 1);
  void Text(Point at, const std::string& text, const TextStyle& style = {});
  // Draws `image` scaled to `box`, mixed with white; strength 1: unchanged.
  void Image(const Box& box, const GrayImage& image, double strength);
  // Clips everything drawn until Unclip to `box`.
  void Clip(const Box& box);
  void Unclip();

  // Writes the file. PERMISSION_DENIED: cannot be written.
  absl::Status Finish();

 private:
  struct Page;
  explicit Canvas(std::unique_ptr<Page> page);
  void SetColour(Colour colour);
  std::unique_ptr<Page> page_;
};

}  // namespace homing::client

#endif  // CLIENT_PICTURE_CANVAS_H_
