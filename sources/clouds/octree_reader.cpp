#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <optional>

#include "glocal/words.hpp"
#include "sources/clouds/cloud_formats.hpp"
#include "sources/clouds/scalar.hpp"
#include "sources/text_lines.hpp"

namespace glocal::clouds {
namespace {

constexpr std::string_view octree_begin = "# Octomap OcTree";
constexpr std::string_view binary_octree_begin = "# Octomap OcTree binary file";

/// The lines up to `data`.
class OctreeHeader {
 public:
  OctreeHeader(std::string_view content, const std::string& file) : file_(file), lines_(content) {
    if (!content.starts_with(binary_octree_begin))
      refuse_cloud(file, 1,
                   fmt::format("is no binary tree of OctoMap, which begins with '{}'; convert one with "
                               "probabilities (.ot) to .bt, or take the map source octomap, a plugin",
                               binary_octree_begin));
    while (read_line()) {
    }
    if (!has_kind_ || !nodes_ || resolution_ == 0.0)
      refuse_cloud(file, lines_.number(),
                   "the header has no line 'id', 'size' or 'res' before 'data'; get a fresh copy");
  }

  [[nodiscard]] std::size_t nodes() const { return *nodes_; }
  /// Side of the smallest voxels, in the file's unit.
  [[nodiscard]] double resolution() const { return resolution_; }
  /// All behind the header.
  [[nodiscard]] std::string_view data() const { return lines_.rest(); }

 private:
  /// False at the end of the header.
  bool read_line() {
    if (!lines_.next_with_fields())
      refuse_cloud(file_, 0, "ends within its header, which needs a line 'data'; get a fresh copy");
    const std::string_view key = lines_.fields()[0];
    if (key == "data") return false;
    const std::string_view value = lines_.fields().size() > 1 ? lines_.fields()[1] : "";
    if (key == "id") check_kind(value);
    if (key == "size") nodes_ = whole_number(value);
    if (key == "res") resolution_ = length(value);
    return true;
  }

  void check_kind(std::string_view kind) {
    if (kind != "OcTree")
      refuse_cloud(file_, lines_.number(),
                   fmt::format("holds a tree of kind '{}'; only OcTree can be read: convert it with "
                               "OctoMap's tools",
                               shown(kind)));
    has_kind_ = true;
  }

  [[nodiscard]] std::size_t whole_number(std::string_view value) const {
    const auto number = whole_number_in(value);
    if (!number)
      refuse_cloud(file_, lines_.number(), fmt::format("size: '{}' is no number of nodes", shown(value)));
    return *number;
  }

  [[nodiscard]] double length(std::string_view value) const {
    const auto number = number_in(value);
    if (!number || !(*number > 0.0 && std::isfinite(*number)))
      refuse_cloud(file_, lines_.number(),
                   fmt::format("res: '{}' is no side of a voxel, a number above 0", shown(value)));
    return *number;
  }

  const std::string& file_;
  TextLines lines_;
  bool has_kind_ = false;
  std::optional<std::size_t> nodes_;
  double resolution_ = 0.0;
};

/// Walks over the nodes as they are stored, each inner node before its children: once to count the voxels,
/// and once more to take them.
class OctreeReader {
 public:
  OctreeReader(std::string_view content, const std::string& file, const CloudOptions& options)
      : file_(file),
        content_(content),
        unit_(options.unit),
        max_bytes_(options.max_size_gb * 1e9),
        header_(content, file),
        at_(content.size() - header_.data().size()),
        cloud_(file, options, channel_columns({"x", "y", "z"}, file, 0)) {}

  Cloud read() {
    const std::size_t begin = at_;
    if (header_.nodes() > 0) {
      read_node({0, 0, 0}, 0, [&](const Key& /*first*/, std::uint32_t side) { count_leaf(side); });
    }
    if (nodes_ != header_.nodes())
      refuse_cloud(
          file_, 0,
          fmt::format("is damaged: the header announces {} nodes, but {} follow up to byte {}; get a "
                      "fresh copy",
                      header_.nodes(), nodes_, at_));
    if (voxels_ == 0) refuse_cloud(file_, 0, "has no occupied voxels; give another file");
    cloud_.reserve(voxels_);
    at_ = begin;
    read_node({0, 0, 0}, 0, [&](const Key& first, std::uint32_t side) { add_leaf(first, side); });
    Cloud cloud = cloud_.finish();
    cloud.voxel_size = unit_ * header_.resolution();
    return cloud;
  }

 private:
  /// The first of the smallest voxels in a cube of the tree, along x, y and z.
  using Key = std::array<std::uint32_t, 3>;
  enum class Child : std::uint8_t { unknown, free, occupied, inner };
  static constexpr int tree_depth = 16;
  static constexpr double middle_key = 32768.0;  ///< Of the voxel that begins at the origin.

  /// An inner node `depth` below the root. Calls visit(first, side) for each occupied leaf.
  template <class Visit>
  void read_node(const Key& first, int depth, Visit visit) {
    constexpr std::size_t node_size = 2, children = 8;
    if (content_.size() - at_ < node_size)
      refuse_at(at_, fmt::format("the file ends after {} of {} nodes", nodes_, header_.nodes()));
    const std::size_t begin = at_;
    const unsigned codes = number_at<std::uint16_t>(content_.data() + begin, std::endian::little);
    if (codes == 0) refuse_at(begin, "an inner node has no children");
    at_ += node_size;
    ++nodes_;
    const std::uint32_t side = 1U << static_cast<unsigned>(tree_depth - depth - 1);
    for (unsigned i = 0; i < children; ++i) {
      const auto child = static_cast<Child>(codes >> 2 * i & 3U);
      const Key key = {first[0] + (i & 1U) * side, first[1] + (i >> 1U & 1U) * side,
                       first[2] + (i >> 2U & 1U) * side};
      if (child == Child::free || child == Child::occupied) ++nodes_;
      if (child == Child::occupied) visit(key, side);
      if (child != Child::inner) continue;
      if (side == 1) refuse_at(begin, fmt::format("a node is deeper than {}", tree_depth));
      read_node(key, depth + 1, visit);
    }
  }

  /// A leaf above the finest size is occupied everywhere.
  void count_leaf(std::uint32_t side) {
    constexpr std::uint64_t point_size = 3 * sizeof(float);
    voxels_ += std::uint64_t{side} * side * side;
    if (static_cast<double>(voxels_ * point_size) > max_bytes_)
      refuse_cloud(file_, 0,
                   fmt::format("its occupied voxels have more than {} GB as points; if it is the right file, "
                               "thin it out",
                               max_bytes_ / 1e9));
  }

  void add_leaf(const Key& first, std::uint32_t side) {
    const auto centre = [&](std::uint32_t key) {
      return (static_cast<double>(key) - middle_key + 0.5) * header_.resolution();
    };
    for (std::uint32_t z = first[2]; z < first[2] + side; ++z) {
      for (std::uint32_t y = first[1]; y < first[1] + side; ++y) {
        for (std::uint32_t x = first[0]; x < first[0] + side; ++x)
          cloud_.add({centre(x), centre(y), centre(z)});
      }
    }
  }

  [[noreturn]] void refuse_at(std::size_t byte, const std::string& what) const {
    refuse_cloud(file_, 0, fmt::format("is damaged at byte {}: {}; get a fresh copy", byte, what));
  }

  const std::string& file_;
  std::string_view content_;
  double unit_, max_bytes_;
  OctreeHeader header_;
  std::size_t at_;  ///< The next byte.
  CloudBuilder cloud_;
  std::size_t nodes_ = 0;     ///< Read, leaves included.
  std::uint64_t voxels_ = 0;  ///< Occupied, of the finest size.
};

}  // namespace

bool is_octree(std::string_view content) {
  return content.starts_with(octree_begin);
}

Cloud read_octree_cloud(std::string_view content, const std::string& file, const CloudOptions& options) {
  return OctreeReader(content, file, options).read();
}

}  // namespace glocal::clouds
