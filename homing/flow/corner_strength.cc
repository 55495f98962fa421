#include "homing/flow/corner_strength.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "homing/base/vector_clones.h"

namespace homing {
namespace {

constexpr int kReach = kCornerBlockPx / 2;

// A row that can be read beyond both its ends.
class PaddedRow {
 public:
  explicit PaddedRow(int size)
      : size_(size), values_(static_cast<std::size_t>(size + 2 * kReach)) {}
  float* data() { return values_.data() + kReach; }
  const float* data() const { return values_.data() + kReach; }
  // BORDER_REFLECT_101.
  void Mirror() {
    float* row = data();
    for (int away = 1; away <= kReach; ++away) {
      row[-away] = row[away];
      row[size_ - 1 + away] = row[size_ - 1 - away];
    }
  }

 private:
  int size_;
  std::vector<float> values_;
};

// grad I grad^T I of one row of pixels: eq 3's products.
struct Products {
  explicit Products(int size) : xx(size), xy(size), yy(size) {}
  PaddedRow xx;
  PaddedRow xy;
  PaddedRow yy;
};

HOMING_VECTOR_CLONES
void AcrossRows(const float* above, const float* here, const float* below, int size, float* smooth,
                float* change) {
  for (int x = 0; x < size; ++x) {
    smooth[x] = above[x] + 2 * here[x] + below[x];
    change[x] = below[x] - above[x];
  }
}

HOMING_VECTOR_CLONES
void Multiply(const float* smooth, const float* change, int size, float* xx, float* xy, float* yy) {
  for (int x = 0; x < size; ++x) {
    const float dx = smooth[x + 1] - smooth[x - 1];
    const float dy = change[x - 1] + 2 * change[x] + change[x + 1];
    xx[x] = dx * dx;
    xy[x] = dx * dy;
    yy[x] = dy * dy;
  }
}

HOMING_VECTOR_CLONES
void SumRows(const std::array<const float*, kCornerBlockPx>& rows, int size, float* sum) {
  for (int x = 0; x < size; ++x) {
    sum[x] = rows[0][x] + rows[1][x] + rows[2][x] + rows[3][x] + rows[4][x];
  }
}

HOMING_VECTOR_CLONES
void LeastEigenvalues(const float* xx, const float* xy, const float* yy, int size, float* out) {
  for (int x = 0; x < size; ++x) {
    const float a = (xx[x - 2] + xx[x - 1] + xx[x] + xx[x + 1] + xx[x + 2]) * 0.5F;
    const float b = xy[x - 2] + xy[x - 1] + xy[x] + xy[x + 1] + xy[x + 2];
    const float c = (yy[x - 2] + yy[x - 1] + yy[x] + yy[x + 1] + yy[x + 2]) * 0.5F;
    out[x] = (a + c) - std::sqrt((a - c) * (a - c) + b * b);
  }
}

int Mirrored(int i, int size) {
  if (i < 0) return -i;
  return i < size ? i : 2 * (size - 1) - i;
}

// The last rows' products, and the sums over them.
class Window {
 public:
  explicit Window(const cv::Mat& image)
      : image_(image),
        smooth_(image.cols),
        change_(image.cols),
        sums_(image.cols),
        products_(kCornerBlockPx, Products(image.cols)) {}

  // REQUIRES: rows come in order.
  void Add(int y) {
    const int rows = image_.rows;
    AcrossRows(image_.ptr<float>(Mirrored(y - 1, rows)), image_.ptr<float>(y),
               image_.ptr<float>(Mirrored(y + 1, rows)), image_.cols, smooth_.data(),
               change_.data());
    smooth_.Mirror();
    change_.Mirror();
    Products& at = products_[static_cast<std::size_t>(y % kCornerBlockPx)];
    Multiply(smooth_.data(), change_.data(), image_.cols, at.xx.data(), at.xy.data(), at.yy.data());
  }

  // REQUIRES: rows up to y + kReach were added.
  void Strength(int y, float* out) {
    SumOf(&Products::xx, y, &sums_.xx);
    SumOf(&Products::xy, y, &sums_.xy);
    SumOf(&Products::yy, y, &sums_.yy);
    LeastEigenvalues(sums_.xx.data(), sums_.xy.data(), sums_.yy.data(), image_.cols, out);
  }

 private:
  void SumOf(PaddedRow Products::*product, int y, PaddedRow* sum) const {
    std::array<const float*, kCornerBlockPx> rows{};
    for (int i = 0; i < kCornerBlockPx; ++i) {
      const int row = Mirrored(y + i - kReach, image_.rows);
      const Products& from = products_[static_cast<std::size_t>(row % kCornerBlockPx)];
      rows[static_cast<std::size_t>(i)] = (from.*product).data();
    }
    SumRows(rows, image_.cols, sum->data());
    sum->Mirror();
  }

  const cv::Mat& image_;
  PaddedRow smooth_;
  PaddedRow change_;
  Products sums_;
  std::vector<Products> products_;
};

}  // namespace

void CornerStrength(const cv::Mat& image, cv::Mat* strength) {
  strength->create(image.size(), CV_32FC1);
  Window window(image);
  for (int y = 0; y < image.rows + kReach; ++y) {
    if (y < image.rows) window.Add(y);
    if (y >= kReach) window.Strength(y - kReach, strength->ptr<float>(y - kReach));
  }
}

}  // namespace homing
