#include "tree_file.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "glocal/error.hpp"

namespace glocal::octomap_plugin {
namespace {

constexpr std::string_view binary_begin = "# Octomap OcTree binary file";
constexpr std::string_view full_begin = "# Octomap OcTree file";
constexpr int depth_of_tree = 16;

struct Header {
  std::string id;
  double size = -1.0;
  double resolution = 0.0;
  std::size_t length = 0;  ///< Bytes before the nodes.
};

/// Keys with their values up to `data`; none if it ends before.
std::optional<Header> read_header(const std::string& content) {
  Header header;
  std::istringstream lines(content);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "id") words >> header.id;
    if (key == "size") words >> header.size;
    if (key == "res") words >> header.resolution;
    if (key != "data") continue;
    if (lines.eof()) return std::nullopt;
    header.length = static_cast<std::size_t>(lines.tellg());
    return header;
  }
  return std::nullopt;
}

/// Walks over the nodes as they are stored, without believing any of them: OctoMap's own readers go on behind
/// the end of a file.
class NodeWalk {
 public:
  NodeWalk(std::string_view nodes, bool binary) : nodes_(nodes), binary_(binary) {}

  /// False if the file ends before its nodes do, or they lie deeper than a tree is.
  bool walk(int depth = 0) {
    const std::size_t bytes = binary_ ? 2 : sizeof(float) + 1;
    if (depth > depth_of_tree || nodes_.size() - at_ < bytes) return false;
    const auto* node = reinterpret_cast<const std::uint8_t*>(nodes_.data()) + at_;
    at_ += bytes;
    ++count_;
    for (int child = 0; child < 8; ++child) {
      if (binary_) {
        const int code = node[child / 4] >> (child % 4 * 2) & 3;
        if (code == 1 || code == 2) ++count_;  // a leaf, which takes no bytes of its own
        if (code != 0 && depth == depth_of_tree) return false;
        if (code == 3 && !walk(depth + 1)) return false;
      } else if ((node[sizeof(float)] >> child & 1) != 0 && !walk(depth + 1)) {
        return false;
      }
    }
    return true;
  }

  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  std::string_view nodes_;
  bool binary_;
  std::size_t at_ = 0;
  std::size_t count_ = 0;
};

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  if (!stream) throw ConfigError(file, "cannot be read");
  return std::move(content).str();
}

Header checked_header(const std::filesystem::path& file, const std::string& content, bool binary) {
  const std::optional<Header> header = read_header(content);
  if (!header) throw ConfigError(file, "ends within its header; get the whole file");
  if (header->id != "OcTree") {
    throw ConfigError(file, "holds a tree of kind '" + header->id +
                                "'; only OcTree can be read: convert it with octomap's tools");
  }
  if (!(header->resolution > 0.0 && std::isfinite(header->resolution))) {
    throw ConfigError(file, "has no resolution: its header needs a line `res` with a number above 0");
  }
  if (header->size == 0.0) throw ConfigError(file, "its tree is empty");
  NodeWalk nodes(std::string_view(content).substr(header->length), binary);
  if (!nodes.walk()) throw ConfigError(file, "is damaged: it ends before its nodes do; get the whole file");
  if (static_cast<double>(nodes.count()) != header->size) {
    throw ConfigError(file, "is damaged: its header tells of another number of nodes than the " +
                                std::to_string(nodes.count()) + " it has");
  }
  return *header;
}

}  // namespace

std::unique_ptr<octomap::OcTree> read_tree(const std::filesystem::path& file) {
  const std::string content = content_of(file);
  const bool binary = content.starts_with(binary_begin);
  if (!binary && !content.starts_with(full_begin)) {
    throw ConfigError(file, "is no file of OctoMap: it does not begin with '" + std::string(full_begin) +
                                "' or '" + std::string(binary_begin) + "'");
  }
  const Header header = checked_header(file, content, binary);
  std::istringstream nodes(content);
  nodes.seekg(static_cast<std::streamoff>(header.length));
  auto tree = std::make_unique<octomap::OcTree>(header.resolution);
  if (binary) {
    tree->readBinaryData(nodes);
  } else {
    tree->readData(nodes);
  }
  return tree;
}

std::string bt_file(const octomap::OcTree& tree) {
  std::ostringstream stream;
  tree.writeBinaryConst(stream);
  return std::move(stream).str();
}

}  // namespace glocal::octomap_plugin
