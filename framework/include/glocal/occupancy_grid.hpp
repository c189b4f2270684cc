// What is known to be free, occupied or unknown.
#pragma once

#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <vector>

#include "glocal/points.hpp"
#include "glocal/pose2.hpp"

namespace glocal {

/// Grids of more cells are refused.
inline constexpr double max_grid_cells = 1e9;

/// What the map knows of a cell.
enum class Cell : std::uint8_t { unknown, free, occupied };

/// Cells in a row, as a std::vector of them, but two bits each: a map of a square kilometre has 400 million.
class PackedCells {
 public:
  using value_type = Cell;

  /// One of them, to be written.
  class Reference {
   public:
    Reference(std::uint64_t& word, unsigned shift) : word_(&word), shift_(shift) {}
    Reference(const Reference&) = default;
    operator Cell() const {  // NOLINT(google-explicit-constructor): reads as the cell
      return static_cast<Cell>(*word_ >> shift_ & mask);
    }
    Reference& operator=(Cell cell) {
      *word_ = (*word_ & ~(mask << shift_)) | static_cast<std::uint64_t>(cell) << shift_;
      return *this;
    }
    // It is read before it is written. NOLINTNEXTLINE(bugprone-unhandled-self-assignment)
    Reference& operator=(const Reference& other) { return *this = static_cast<Cell>(other); }

   private:
    std::uint64_t* word_;
    unsigned shift_;
  };

  template <class Cells, class Value>
  class Iterator {
   public:
    using iterator_category = std::random_access_iterator_tag;
    using value_type = Cell;
    using difference_type = std::ptrdiff_t;
    using pointer = void;
    using reference = Value;

    Iterator() = default;
    Iterator(Cells* cells, std::ptrdiff_t at) : cells_(cells), at_(at) {}
    Value operator*() const { return (*cells_)[static_cast<std::size_t>(at_)]; }
    Value operator[](std::ptrdiff_t n) const { return *(*this + n); }
    Iterator& operator+=(std::ptrdiff_t n) {
      at_ += n;
      return *this;
    }
    Iterator& operator-=(std::ptrdiff_t n) { return *this += -n; }
    Iterator& operator++() { return *this += 1; }
    Iterator& operator--() { return *this -= 1; }
    Iterator operator++(int) { return {cells_, at_++}; }
    Iterator operator--(int) { return {cells_, at_--}; }
    friend Iterator operator+(Iterator a, std::ptrdiff_t n) { return a += n; }
    friend Iterator operator+(std::ptrdiff_t n, Iterator a) { return a += n; }
    friend Iterator operator-(Iterator a, std::ptrdiff_t n) { return a -= n; }
    friend std::ptrdiff_t operator-(const Iterator& a, const Iterator& b) { return a.at_ - b.at_; }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.at_ == b.at_; }
    friend auto operator<=>(const Iterator& a, const Iterator& b) { return a.at_ <=> b.at_; }

   private:
    Cells* cells_ = nullptr;
    std::ptrdiff_t at_ = 0;
  };
  using iterator = Iterator<PackedCells, Reference>;
  using const_iterator = Iterator<const PackedCells, Cell>;

  PackedCells() = default;
  explicit PackedCells(std::size_t size, Cell cell = Cell::unknown);
  PackedCells(std::initializer_list<Cell> cells);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] Cell operator[](std::size_t i) const {
    return static_cast<Cell>(words_[i / per_word] >> shift_of(i) & mask);
  }
  [[nodiscard]] Reference operator[](std::size_t i) { return {words_[i / per_word], shift_of(i)}; }
  [[nodiscard]] iterator begin() { return {this, 0}; }
  [[nodiscard]] iterator end() { return {this, static_cast<std::ptrdiff_t>(size_)}; }
  [[nodiscard]] const_iterator begin() const { return {this, 0}; }
  [[nodiscard]] const_iterator end() const { return {this, static_cast<std::ptrdiff_t>(size_)}; }

  /// Sets n of them from `begin` on.
  void fill(std::size_t begin, std::size_t n, Cell cell);

  /// Calls visit(number) for those from `begin` on and before `end` that are occupied, in their order.
  template <class Visit>
  void for_occupied(std::size_t begin, std::size_t end, Visit visit) const {
    constexpr std::uint64_t high_bits = 0xaaaaaaaaaaaaaaaaULL;  // set in no other kind of cell
    for (std::size_t w = begin / per_word; w * per_word < end; ++w) {
      for (std::uint64_t left = words_[w] & high_bits; left != 0; left &= left - 1) {
        const std::size_t i = w * per_word + static_cast<std::size_t>(std::countr_zero(left)) / bits;
        if (i >= begin && i < end) visit(i);
      }
    }
  }

  /// All of them, 32 in a word.
  [[nodiscard]] const std::vector<std::uint64_t>& words() const { return words_; }

  friend bool operator==(const PackedCells&, const PackedCells&) = default;

 private:
  static constexpr std::size_t bits = 2;
  static constexpr std::size_t per_word = 64 / bits;
  static constexpr std::uint64_t mask = 3;
  [[nodiscard]] static unsigned shift_of(std::size_t i) { return static_cast<unsigned>(i % per_word * bits); }
  [[nodiscard]] static std::uint64_t all(Cell cell) {
    return static_cast<std::uint64_t>(cell) * 0x5555555555555555ULL;
  }

  std::size_t size_ = 0;
  std::vector<std::uint64_t> words_;  ///< What is behind the last cell is 0.
};

/// Square cells over a rectangle; row 0 is the lowest y of the grid's frame, cell (0, 0) starts at its
/// origin.
struct OccupancyGrid {
  Pose2 map_from_grid;      ///< Outer corner of cell (0, 0), and the direction of the columns.
  double resolution = 0.0;  ///< Side of a cell, m.
  int width = 0;            ///< Cells along the grid's x.
  int height = 0;           ///< Cells along the grid's y.
  PackedCells cells;        ///< width * height, row by row.

  /// The cell under a point of the map's frame; outside the grid everything is unknown.
  [[nodiscard]] Cell at(double map_x, double map_y) const;
  [[nodiscard]] PackedCells::Reference cell(int column, int row) { return cells[index(column, row)]; }
  [[nodiscard]] Cell cell(int column, int row) const { return cells[index(column, row)]; }
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }
  /// Whether there is a cell there.
  [[nodiscard]] bool holds(int column, int row) const {
    return column >= 0 && row >= 0 && column < width && row < height;
  }
  /// Centre of a cell in the map's frame.
  [[nodiscard]] Pose2 centre(int column, int row) const {
    return map_from_grid * Pose2{(column + 0.5) * resolution, (row + 0.5) * resolution, 0.0};
  }
};

/// Calls visit(column, row) for each cell, row by row.
template <class Visit>
void for_each_cell(const OccupancyGrid& grid, Visit visit) {
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) visit(column, row);
  }
}

/// The cells under many places in the map's frame, in double precision.
class CellsAt {
 public:
  /// The grid must outlive this.
  explicit CellsAt(const OccupancyGrid& grid);
  /// Outside the grid everything is unknown.
  [[nodiscard]] Cell operator()(double map_x, double map_y) const;

 private:
  const OccupancyGrid& grid_;
  Pose2 grid_from_map_;
  double cosine_, sine_;
};

/// The cells under many points, which one motion takes to the map's frame.
class CellsUnder {
 public:
  /// The grid must outlive this.
  CellsUnder(const OccupancyGrid& grid, const Pose2& map_from_points);
  /// Outside the grid everything is unknown.
  [[nodiscard]] Cell operator()(const Point& p) const;
  /// Of all points: what `cells` had is lost.
  void find(const Points& points, std::vector<Cell>& cells) const;

 private:
  const OccupancyGrid& grid_;
  Transform grid_from_points_;
  float scale_;  ///< Cells per metre; 0 without a grid.
};

/// The centres of all occupied cells, row by row, m, in the map's frame.
[[nodiscard]] Points occupied_centres(const OccupancyGrid& grid);

}  // namespace glocal
