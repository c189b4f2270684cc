// An index of a map in a file, to be read by mapping it into memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

#include "glocal/global_map.hpp"
#include "matchers/common/shared_array.hpp"

namespace glocal {

/// What an index was made from.
struct IndexOrigin {
  std::uint64_t map = 0;  ///< digest_of() the map.
  std::string rule;       ///< "min_length 0.5, max_length 6": everything else it depends on.
};

/// Of a map's points, cells and free voxels.
[[nodiscard]] std::uint64_t digest_of(const GlobalMap& map);

/// The content of a file with an index of this kind in these sections.
[[nodiscard]] std::string saved_index(const std::string& kind, const IndexOrigin& origin,
                                      std::initializer_list<std::span<const std::byte>> sections);

/// The bytes of such a file with size and checksum that fit them, wherever they come from (for tests); what
/// is too short for a header is left alone.
[[nodiscard]] std::string with_checksum(std::string file);

/// Such a file, mapped read-only: processes that use the same one share its memory. It is whole and belongs
/// to the map and the rule it is asked for; what the values of its sections mean is for the index to check.
/// Replace it by renaming, as `glocal map index` does, never by writing into it while it is in use.
class SavedIndex {
 public:
  /// Throws ConfigError, with the command that builds the file anew, if it cannot be read, is damaged, of
  /// another version or byte order, or of another origin.
  SavedIndex(std::filesystem::path file, const IndexOrigin& origin);

  /// What is in it: "oriented point pairs".
  [[nodiscard]] std::string kind() const { return text(1); }

  /// Throws ConfigError if there is no such section.
  template <class T>
  [[nodiscard]] SharedArray<T> section(std::size_t i) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::span<const std::byte> bytes = section_bytes(i + 2, sizeof(T));  // after rule and kind
    // Sections begin at multiples of 64 bytes.
    return {{reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)}, bytes_};
  }

  /// What an index has to check of its sections. Throw ConfigError.
  void expect(const std::string& kind) const;
  /// Where bins begin, and where the last one ends: rising from 0 to the number of items.
  void expect_bins(std::span<const std::uint32_t> begins, std::size_t items) const;
  /// Coordinates and angles of points.
  void expect_finite(std::span<const float> values) const;
  /// Whether sections of these sizes belong to one index.
  void expect_fit(bool parts_fit) const;
  /// Items that consist of the numbers of points.
  template <class T>
  void expect_below(std::size_t points, std::span<const T> items) const {
    static_assert(std::has_unique_object_representations_v<T> && sizeof(T) % sizeof(std::uint32_t) == 0);
    expect_numbers_below(points, {reinterpret_cast<const std::uint32_t*>(items.data()),
                                  items.size() * sizeof(T) / sizeof(std::uint32_t)});
  }
  /// Numbers of points, or `none`.
  void expect_below_or(std::uint32_t none, std::size_t points, std::span<const std::uint32_t> numbers) const;

  /// Throws ConfigError: the file is at fault, and this is what is wrong with it.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void check(const IndexOrigin& origin) const;
  void expect_numbers_below(std::size_t points, std::span<const std::uint32_t> numbers) const;
  [[nodiscard]] std::string text(std::size_t section) const;
  [[nodiscard]] std::span<const std::byte> section_bytes(std::size_t i, std::size_t item) const;

  std::filesystem::path file_;
  std::size_t size_ = 0;
  std::shared_ptr<const std::byte> bytes_;
};

}  // namespace glocal
