// Octrees written byte by byte, as OctoMap's file formats have them.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glocal::test {

/// A leaf of an octree, at the given depth: 16 for the smallest, with keys counted from 32768 at the origin.
struct TreeLeaf {
  int x = 32768;
  int y = 32768;
  int z = 32768;
  float log_odds = 1.0F;  ///< .bt files keep its sign only.
  int depth = 16;
};

class TreeWriter {
 public:
  explicit TreeWriter(bool binary) : binary_(binary) {}

  std::string file(const std::vector<TreeLeaf>& leaves, double resolution) {
    std::string nodes;
    count_ = 1;
    write_node(leaves, 0, nodes);
    return std::string("# Octomap OcTree ") + (binary_ ? "binary " : "") +
           "file\n# made by hand\nid OcTree\nsize " + std::to_string(count_) + "\nres " +
           std::to_string(resolution) + "\ndata\n" + nodes;
  }

 private:
  void write_node(const std::vector<TreeLeaf>& leaves, int depth, std::string& nodes) {
    std::vector<std::vector<TreeLeaf>> children(8);
    for (const TreeLeaf& leaf : leaves) {
      const int shift = 15 - depth;
      const int child = (leaf.x >> shift & 1) + 2 * (leaf.y >> shift & 1) + 4 * (leaf.z >> shift & 1);
      children[static_cast<std::size_t>(child)].push_back(leaf);
    }
    unsigned codes = 0;  // two bits a child: 1 free, 2 occupied, 3 with children of its own
    unsigned present = 0;
    for (unsigned i = 0; i < 8; ++i) {
      if (children[i].empty()) continue;
      ++count_;
      present |= 1U << i;
      const TreeLeaf& first = children[i].front();
      const bool is_leaf = first.depth == depth + 1;
      codes |= (is_leaf ? (first.log_odds > 0.0F ? 2U : 1U) : 3U) << 2 * i;
    }
    if (binary_) {
      nodes += {static_cast<char>(codes & 0xFFU), static_cast<char>(codes >> 8U)};
    } else {
      append_float(0.0F, nodes);
      nodes += static_cast<char>(present);
    }
    for (const auto& child : children) {
      if (child.empty()) continue;
      if (child.front().depth != depth + 1) {
        write_node(child, depth + 1, nodes);
      } else if (!binary_) {
        append_float(child.front().log_odds, nodes);
        nodes += '\0';
      }
    }
  }

  static void append_float(float value, std::string& bytes) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (unsigned shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(bits >> shift & 0xFFU);
  }

  bool binary_;
  std::size_t count_ = 0;
};

[[nodiscard]] inline std::string bt_file(const std::vector<TreeLeaf>& leaves, double resolution) {
  return TreeWriter(true).file(leaves, resolution);
}
[[nodiscard]] inline std::string ot_file(const std::vector<TreeLeaf>& leaves, double resolution) {
  return TreeWriter(false).file(leaves, resolution);
}

}  // namespace glocal::test
