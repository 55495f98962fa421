#include "client/picture/axes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "absl/strings/str_format.h"

namespace homing::client {
namespace {

constexpr double kLabelSize = 10;

std::string TickText(double value) {
  return absl::StrFormat("%g", std::abs(value) < 1e-12 ? 0 : value);
}

}  // namespace

std::vector<double> RoundTicks(const Range& range, int count) {
  const double low = std::min(range.low, range.high);
  const double high = std::max(range.low, range.high);
  const double raw = (high - low) / std::max(count, 1);
  if (!(raw > 0) || !std::isfinite(raw)) return {low};
  const double power = std::pow(10, std::floor(std::log10(raw)));
  const double mantissa = raw / power;
  const double nice = mantissa < 1.5 ? 1 : (mantissa < 3.5 ? 2 : (mantissa < 7.5 ? 5 : 10));
  const double distance = nice * power;
  std::vector<double> ticks;
  const auto first = static_cast<std::int64_t>(std::ceil(low / distance - 1e-9));
  const auto last = static_cast<std::int64_t>(std::floor(high / distance + 1e-9));
  for (std::int64_t i = first; i <= last; ++i) ticks.push_back(static_cast<double>(i) * distance);
  return ticks;
}

Axes::Axes(Canvas* canvas, const Box& box, const Range& x, const Range& y)
    : canvas_(canvas), box_(box), x_(x), y_(y) {}

double Axes::X(double value) const {
  return box_.x + box_.width * (value - x_.low) / (x_.high - x_.low);
}

double Axes::Y(double value) const {
  return box_.y + box_.height * (1 - (value - y_.low) / (y_.high - y_.low));
}

void Axes::Draw(const AxisText& text) {
  const double bottom = box_.y + box_.height;
  for (const double tick : RoundTicks(x_, static_cast<int>(std::lround(box_.width / 70)))) {
    canvas_->Line({X(tick), box_.y}, {X(tick), bottom}, kPale, 0.6);
    canvas_->Text({X(tick), bottom + 14}, TickText(tick), {kLabelSize, Align::kCenter});
  }
  for (const double tick : RoundTicks(y_, static_cast<int>(std::lround(box_.height / 40)))) {
    canvas_->Line({box_.x, Y(tick)}, {box_.x + box_.width, Y(tick)}, kPale, 0.6);
    canvas_->Text({box_.x - 6, Y(tick) + 3.5}, TickText(tick), {kLabelSize, Align::kRight});
  }
  canvas_->Outline(box_, kGray, 0.8);
  canvas_->Text({box_.x, box_.y - 9}, text.title, {12, Align::kLeft, kBlack, true});
  canvas_->Text({box_.x + box_.width / 2, bottom + 30}, text.x, {11, Align::kCenter});
  canvas_->Text({box_.x - 38, box_.y + box_.height / 2}, text.y,
                {11, Align::kCenter, kBlack, false, -std::numbers::pi / 2});
}

void Axes::DrawEntry(const LegendEntry& entry, Point at) {
  if (entry.line) {
    canvas_->Line({at.x, at.y - 4}, {at.x + 18, at.y - 4}, entry.colour, 2);
  } else {
    canvas_->Disc({at.x + 9, at.y - 4}, 3, entry.colour);
  }
  canvas_->Text({at.x + 24, at.y}, entry.text, {kLabelSize});
}

void Axes::Legend(const std::vector<LegendEntry>& entries, LegendPlace place) {
  constexpr double kLineHeight = 15;
  // Average width of a letter.
  constexpr double kLetter = 5.8;
  double widest = 0;
  double sum = 0;
  for (const LegendEntry& entry : entries) {
    const double width = 36 + kLetter * static_cast<double>(entry.text.size());
    widest = std::max(widest, width);
    sum += width;
  }
  if (place == LegendPlace::kAbove) {
    double x = box_.x + box_.width - sum;
    for (const LegendEntry& entry : entries) {
      DrawEntry(entry, {x, box_.y - 9});
      x += 36 + kLetter * static_cast<double>(entry.text.size());
    }
    return;
  }
  const double height = kLineHeight * static_cast<double>(entries.size()) + 6;
  const double x = box_.x + box_.width - widest - 8;
  double y = place == LegendPlace::kUpperRight ? box_.y + 8 : box_.y + box_.height - height - 8;
  canvas_->Fill({x, y, widest, height}, {1, 1, 1, 0.85});
  for (const LegendEntry& entry : entries) {
    y += kLineHeight;
    DrawEntry(entry, {x + 6, y - 1});
  }
}

}  // namespace homing::client
