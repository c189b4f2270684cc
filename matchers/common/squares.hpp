// Points of the plane sorted into squares, to find those that are near.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace glocal {

/// Numbers of points in squares at least as wide as the farthest distance asked for, so that all that are
/// nearer lie in nine of them.
class Squares {
 public:
  /// x and y (m) have the same length.
  Squares(const std::vector<float>& x, const std::vector<float>& y, double side) {
    if (x.empty()) return;
    const auto [min_x, max_x] = std::minmax_element(x.begin(), x.end());
    const auto [min_y, max_y] = std::minmax_element(y.begin(), y.end());
    min_x_ = *min_x;
    min_y_ = *min_y;
    // Empty squares take memory, too: of points that are far from each other these are wider.
    constexpr float most_in_a_row = 2048.0F;
    side_ = std::max<double>(side, std::max(*max_x - *min_x, *max_y - *min_y) / most_in_a_row);
    columns_ = static_cast<int>((*max_x - *min_x) / side_) + 1;
    rows_ = static_cast<int>((*max_y - *min_y) / side_) + 1;
    members_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (std::size_t i = 0; i < x.size(); ++i) {
      members_[index(column(x[i]), row(y[i]))].push_back(static_cast<std::uint32_t>(i));
    }
  }

  /// How many squares there are, and the points of one of them.
  [[nodiscard]] std::size_t size() const { return members_.size(); }
  [[nodiscard]] const std::vector<std::uint32_t>& members(std::size_t square) const {
    return members_[square];
  }
  /// All points within the distance of one of a square's, and some farther ones; and how many they are.
  [[nodiscard]] std::vector<std::uint32_t> around(std::size_t square) const {
    std::vector<std::uint32_t> all;
    for_squares_around(column_of(square), row_of(square), [&](const std::vector<std::uint32_t>& members) {
      all.insert(all.end(), members.begin(), members.end());
    });
    return all;
  }
  [[nodiscard]] std::size_t size_around(std::size_t square) const {
    std::size_t size = 0;
    for_squares_around(column_of(square), row_of(square),
                       [&](const std::vector<std::uint32_t>& members) { size += members.size(); });
    return size;
  }

  /// Calls visit(number) for all points within the distance of one of them, and some farther ones.
  template <class Visit>
  void near(float x, float y, Visit visit) const {
    for_squares_around(column(x), row(y), [&](const std::vector<std::uint32_t>& members) {
      for (const std::uint32_t i : members) visit(i);
    });
  }

 private:
  template <class Visit>
  void for_squares_around(int column, int row, Visit visit) const {
    for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r) {
      for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c)
        visit(members_[index(c, r)]);
    }
  }
  [[nodiscard]] int column_of(std::size_t square) const {
    return static_cast<int>(square % static_cast<std::size_t>(columns_));
  }
  [[nodiscard]] int row_of(std::size_t square) const {
    return static_cast<int>(square / static_cast<std::size_t>(columns_));
  }
  [[nodiscard]] int column(float x) const { return static_cast<int>((x - min_x_) / side_); }
  [[nodiscard]] int row(float y) const { return static_cast<int>((y - min_y_) / side_); }
  [[nodiscard]] std::size_t index(int c, int r) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c);
  }

  double side_ = 1.0;
  float min_x_ = 0.0F, min_y_ = 0.0F;
  int columns_ = 0, rows_ = 0;
  std::vector<std::vector<std::uint32_t>> members_;
};

}  // namespace glocal
