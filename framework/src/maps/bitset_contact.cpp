#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "glocal/contact.hpp"
#include "glocal/error.hpp"
#include "glocal/extent.hpp"
#include "glocal/parallel.hpp"
#include "maps/count_contacts.hpp"

namespace glocal {
namespace {

constexpr double voxels_per_epsilon = 4.0;
constexpr double voxels_per_epsilon_on_huge_maps = 2.0;
constexpr std::size_t voxels_per_word = 32;
/// Rows of the coarse bits are whole words too.
constexpr double columns_step = voxels_per_word << VoxelGrid::coarse_shift;

/// The voxels along an axis: where the first one begins, and how many there are.
struct VoxelAxis {
  float begin;
  double voxels;
};

/// Those that are within `epsilon` of the points and one more to either side. Far from the origin single
/// precision may round by more than a voxel: what is not there at all would then be marked.
VoxelAxis axis_of(const Extent& range, double epsilon, double scale) {
  const double margin = epsilon + 1.0 / scale;
  auto begin = static_cast<float>(range.low - margin);
  while (begin > range.low - epsilon) begin = std::nextafter(begin, -std::numeric_limits<float>::infinity());
  return {begin, std::ceil((range.high + margin - begin) * scale) + 1.0};
}

/// Sets the bits of a row from the first to the last; word(n) is the one that has those from 32 n on.
template <class Word>
void set_bits(std::size_t first, std::size_t last, Word word) {
  const std::size_t first_word = first / voxels_per_word, last_word = last / voxels_per_word;
  for (std::size_t n = first_word; n <= last_word; ++n) {
    std::uint32_t bits = ~std::uint32_t{0};
    if (n == first_word) bits &= ~std::uint32_t{0} << first % voxels_per_word;
    if (n == last_word) bits &= ~std::uint32_t{0} >> (voxels_per_word - 1 - last % voxels_per_word);
    word(n) |= bits;
  }
}

}  // namespace

BitsetContact::BitsetContact(const Points& points, double epsilon, int threads) {
  if (points.empty()) {
    words_.assign(1, 0);  // a place to look at, although nothing is there
    coarse_words_.assign(1, 0);
    return;
  }
  const Extent x = extent_of(points.x);
  const Extent y = extent_of(points.y);
  const Extent z = extent_of(points.z);
  const bool planar = z.low == z.high;
  const bool is_huge = planar && x.length() * y.length() > huge_area;
  scale_ = static_cast<float>((is_huge ? voxels_per_epsilon_on_huge_maps : voxels_per_epsilon) / epsilon);
  const VoxelAxis along_x = axis_of(x, epsilon, scale_), along_y = axis_of(y, epsilon, scale_);
  const VoxelAxis along_z =
      planar ? VoxelAxis{static_cast<float>(z.low - epsilon), 1.0} : axis_of(z, epsilon, scale_);
  const double columns = std::ceil(along_x.voxels / columns_step) * columns_step;
  const double rows = along_y.voxels;
  const double layers = along_z.voxels;
  const auto check_size = [&](double bytes) {
    constexpr double largest_bytes = 1024.0 * 1024.0 * 1024.0;
    if (bytes <= largest_bytes) return;
    throw ConfigError(
        "", fmt::format("a contact grid over {:.0f} m x {:.0f} m x {:.0f} m with contact_epsilon {} m would "
                        "need {:.1f} GiB, at most 1 GiB is allowed; use a larger contact_epsilon or a "
                        "smaller map",
                        x.high - x.low, y.high - y.low, z.high - z.low, epsilon, bytes / largest_bytes));
  };
  const auto bricks = [](double lines) { return std::ceil(lines / (1U << brick_shift)); };
  const double words = columns / voxels_per_word * (planar ? rows : bricks(rows) * bricks(layers));
  check_size(words * sizeof(std::uint32_t));
  min_ = {along_x.begin, along_y.begin, along_z.begin};
  scale_z_ = planar ? static_cast<float>(0.5 / epsilon) : scale_;
  columns_ = static_cast<std::size_t>(columns);
  rows_ = static_cast<std::size_t>(rows);
  layers_ = static_cast<std::size_t>(layers);
  if (planar) {
    words_.assign(static_cast<std::size_t>(words), 0);
  } else {
    brick_rows_ = static_cast<std::size_t>(bricks(rows));
    bricks_.assign(static_cast<std::size_t>(words), 0);
    const std::size_t bricks_and_empty_one = place_bricks(points, epsilon) + 1;
    check_size(static_cast<double>(bricks_and_empty_one * brick_words * sizeof(std::uint32_t)));
    words_.assign(bricks_and_empty_one * brick_words, 0);
  }
  const auto joined = [](std::size_t n) { return ((n - 1) >> VoxelGrid::coarse_shift) + 1; };
  coarse_rows_ = joined(rows_);
  coarse_words_.assign(joined(columns_) * coarse_rows_ * joined(layers_) / voxels_per_word, 0);
  dilate(points, epsilon, threads);
}

/// In the order in which the points come to them, so that neighbours are near each other. Returns how many
/// they are.
std::size_t BitsetContact::place_bricks(const Points& points, double epsilon) {
  const double reach = epsilon * scale_;
  std::size_t placed = 0;
  const auto range = [&](float at, float least, std::size_t voxels) {
    const double centre = (static_cast<double>(at) - least) * scale_;
    return std::pair(static_cast<std::size_t>(centre - reach) / voxels,
                     static_cast<std::size_t>(centre + reach) / voxels);
  };
  constexpr std::size_t side = std::size_t{1} << brick_shift;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [left, right] = range(points.x[i], min_.x, voxels_per_word);
    const auto [front, back] = range(points.y[i], min_.y, side);
    const auto [low, high] = range(points.z[i], min_.z, side);
    for (std::size_t layer = low; layer <= high; ++layer) {
      for (std::size_t row = front; row <= back; ++row) {
        for (std::size_t column = left; column <= right; ++column) {
          std::uint32_t& brick = bricks_[(layer * brick_rows_ + row) * (columns_ / voxels_per_word) + column];
          if (brick == 0) brick = static_cast<std::uint32_t>(++placed * brick_words);
        }
      }
    }
  }
  return placed;
}

VoxelGrid BitsetContact::grid() const {
  const auto bits = [](const std::vector<std::uint32_t>& words, std::size_t columns, std::size_t rows,
                       const std::vector<std::uint32_t>& bricks) {
    const auto row_words = static_cast<std::uint32_t>(columns / voxels_per_word);
    return VoxelBits{words.data(), row_words, row_words * static_cast<std::uint32_t>(rows),
                     bricks.empty() ? nullptr : bricks.data()};
  };
  return {.fine = bits(words_, columns_, bricks_.empty() ? rows_ : brick_rows_, bricks_),
          .coarse = bits(coarse_words_, columns_ >> VoxelGrid::coarse_shift, coarse_rows_, {}),
          .columns = static_cast<float>(columns_),
          .rows = static_cast<float>(rows_),
          .layers = static_cast<float>(layers_),
          .min = min_,
          .scale = scale_,
          .scale_z = scale_z_};
}

std::size_t BitsetContact::count(const Points& points, std::size_t begin, std::size_t n,
                                 const Transform& map_from_points) const {
  constexpr std::array<std::uint32_t, 1> any{0};
  return count_while(points, begin, n, n, any, map_from_points).in_contact;
}

ContactIndex::Count BitsetContact::count_while(const Points& points, std::size_t begin, std::size_t n,
                                               std::size_t batch, std::span<const std::uint32_t> least,
                                               const Transform& map_from_points) const {
  return count_contacts(grid(), map_from_points,
                        {points.x.data() + begin, points.y.data() + begin, points.z.data() + begin, n}, batch,
                        least);
}

void BitsetContact::count_at_most(const Points& points, std::size_t n, const MotionBatch& motions,
                                  std::size_t size, const BatchColumn& begins, BatchColumn& at_most) const {
  count_coarse(grid(), points, n, motions, size, begins, at_most);
}

/// Each band of rows by itself, as no two of them share a word.
void BitsetContact::dilate(const Points& points, double epsilon, int threads) {
  constexpr int rows_together = 32;  // of a brick, of coarse voxels
  for_bands(threads, static_cast<int>(rows_), rows_together, [&](int begin, int end) {
    const double low = min_.y + begin / double{scale_} - 2.0 * epsilon;
    const double high = min_.y + end / double{scale_} + 2.0 * epsilon;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points.y[i] >= low && points.y[i] <= high) dilate(points[i], epsilon, begin, end);
    }
  });
}

/// Those of the rows from one on and before another.
void BitsetContact::dilate(const Point& p, double epsilon, int begin_row, int end_row) {
  // In voxels, relative to voxel (0, 0, 0).
  const double reach = epsilon * scale_;
  const double x = (static_cast<double>(p.x) - min_.x) * scale_;
  const double y = (static_cast<double>(p.y) - min_.y) * scale_;
  const double z = (static_cast<double>(p.z) - min_.z) * scale_;
  const bool planar = layers_ == 1;
  const auto first = [&](double centre) { return static_cast<int>(std::ceil(centre - reach - 0.5)); };
  const auto last = [&](double centre) { return static_cast<int>(std::floor(centre + reach - 0.5)); };
  const auto squared = [](double centre, int voxel) {
    const double d = voxel + 0.5 - centre;
    return d * d;
  };
  const int first_layer = planar ? 0 : first(z);
  const int last_layer = planar ? 0 : last(z);
  for (int layer = first_layer; layer <= last_layer; ++layer) {
    const double left_by_z = reach * reach - (planar ? 0.0 : squared(z, layer));
    for (int row = std::max(begin_row, first(y)); row < end_row && row <= last(y); ++row) {
      const double left_by_y = left_by_z - squared(y, row);
      int left = first(x), right = last(x);
      while (left <= right && squared(x, left) > left_by_y) ++left;
      while (left <= right && squared(x, right) > left_by_y) --right;
      if (left > right) continue;
      set(static_cast<std::size_t>(left), static_cast<std::size_t>(right), static_cast<std::size_t>(row),
          static_cast<std::size_t>(layer));
    }
  }
}

/// Some neighbours in a row, the last one included.
void BitsetContact::set(std::size_t first_column, std::size_t last_column, std::size_t row,
                        std::size_t layer) {
  const std::size_t row_words = columns_ / voxels_per_word;
  constexpr std::size_t within = (std::size_t{1} << brick_shift) - 1;
  set_bits(first_column, last_column, [&](std::size_t word) -> std::uint32_t& {
    if (bricks_.empty()) return words_[row * row_words + word];
    const std::size_t brick =
        ((layer >> brick_shift) * brick_rows_ + (row >> brick_shift)) * row_words + word;
    return words_[bricks_[brick] + ((layer & within) << brick_shift) + (row & within)];
  });
  constexpr unsigned shift = VoxelGrid::coarse_shift;
  const std::size_t coarse_row = ((layer >> shift) * coarse_rows_ + (row >> shift)) * (row_words >> shift);
  set_bits(first_column >> shift, last_column >> shift,
           [&](std::size_t word) -> std::uint32_t& { return coarse_words_[coarse_row + word]; });
}

}  // namespace glocal
