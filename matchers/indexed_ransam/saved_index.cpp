#include "matchers/indexed_ransam/saved_index.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string_view>

#include "glocal/error.hpp"
#include "glocal/rng.hpp"

namespace glocal {
namespace {

constexpr std::array<char, 8> magic = {'g', 'l', 'o', 'c', 'a', 'l', 'i', 'x'};
constexpr std::uint32_t byte_order = 0x01020304;
constexpr std::uint32_t other_byte_order = 0x04030201;
/// Counts up when the format changes, or what goes into an index of the same map and rule.
constexpr std::uint32_t version = 3;
constexpr std::size_t alignment = 64;
constexpr const char* names_missing_points = "the index is damaged: it names points that it does not have";

/// The file begins with this; then come the places of all sections, and the sections: first the texts of rule
/// and kind.
struct Header {
  std::array<char, 8> magic = {};
  std::uint32_t byte_order = 0;
  std::uint32_t version = 0;
  std::uint64_t file_size = 0;
  std::uint64_t map = 0;
  std::uint64_t sections = 0;
  std::uint64_t checksum = 0;  ///< Of everything else.
};
struct Place {
  std::uint64_t begin = 0;
  std::uint64_t size = 0;
};

/// In four lanes, so that no multiplication has to wait for the one before it. Tells damage and mix-ups, not
/// forgery.
std::uint64_t digest(std::span<const std::byte> bytes, std::uint64_t seed = 0) {
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15ULL;
  std::array<std::uint64_t, 4> lanes = {seed, seed + 1, seed + 2, seed + 3};
  for (std::size_t i = 0; i < bytes.size(); i += sizeof(lanes)) {
    std::array<std::uint64_t, 4> words{};
    std::memcpy(words.data(), &bytes[i], std::min(sizeof(words), bytes.size() - i));
    for (std::size_t k = 0; k < lanes.size(); ++k) lanes[k] = mix64(lanes[k] ^ words[k]) + odd;
  }
  std::uint64_t all = bytes.size();
  for (const std::uint64_t lane : lanes) all = mix64(all ^ lane) + odd;
  return all;
}

template <class T>
std::uint64_t digest(const std::vector<T>& values, std::uint64_t seed) {
  return digest(std::as_bytes(std::span(values)), seed);
}

std::uint64_t checksum_of(Header header, std::span<const std::byte> rest) {
  header.checksum = 0;
  return digest(rest, digest(std::as_bytes(std::span(&header, 1))));
}

/// Where the rules differ: "max_entries 1000 instead of 5000".
std::string difference(std::string_view is, std::string_view wanted) {
  const auto next = [](std::string_view& rest) {
    const std::string_view item = rest.substr(0, rest.find(", "));
    rest.remove_prefix(std::min(rest.size(), item.size() + 2));
    return item;
  };
  std::string all;
  while (!is.empty() || !wanted.empty()) {
    const std::string_view here = next(is);
    const std::string_view there = next(wanted);
    if (here == there) continue;
    all += fmt::format("{}{} instead of {}", all.empty() ? "" : ", ", here, there);
  }
  return all;
}

struct Mapping {
  std::shared_ptr<const std::byte> bytes;
  std::size_t size = 0;
  std::string why_not;
};

/// Regular files only: opening a named pipe may block for ever.
Mapping map_into_memory(const std::filesystem::path& file) {
  const auto failed = [] { return Mapping{nullptr, 0, std::strerror(errno)}; };
  const int opened = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (opened < 0) return failed();
  const std::shared_ptr<const void> closer(nullptr, [opened](const void*) { ::close(opened); });
  struct stat status {};
  if (::fstat(opened, &status) != 0) return failed();
  if (!S_ISREG(status.st_mode)) return {nullptr, 0, "not a regular file"};
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return {nullptr, 0, "the file is empty"};
  void* const bytes = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, opened, 0);
  if (bytes == MAP_FAILED) return failed();
  return {{static_cast<const std::byte*>(bytes), [bytes, size](const std::byte*) { ::munmap(bytes, size); }},
          size,
          ""};
}

}  // namespace

std::uint64_t digest_of(const GlobalMap& map) {
  const OccupancyGrid& grid = map.grid();
  const Pose2& pose = grid.map_from_grid;
  std::uint64_t all = digest(map.points().x, 0);
  all = digest(map.points().y, all);
  all = digest(map.points().z, all);
  all = digest(std::vector{pose.x, pose.y, pose.theta, grid.resolution}, all);
  all = digest(std::vector{grid.width, grid.height}, all);
  all = digest(grid.cells, all);
  const FreeVoxels& free = map.free_voxels();
  const Pose2& voxels = free.map_from_voxels();
  all = digest(std::vector{voxels.x, voxels.y, voxels.theta, free.side()}, all);
  return digest(std::as_bytes(free.bricks()), all);
}

std::string saved_index(const std::string& kind, const IndexOrigin& origin,
                        std::initializer_list<std::span<const std::byte>> sections) {
  std::vector<std::span<const std::byte>> all = {std::as_bytes(std::span(origin.rule)),
                                                 std::as_bytes(std::span(kind))};
  all.insert(all.end(), sections);
  std::vector<Place> places;
  std::size_t end = sizeof(Header) + all.size() * sizeof(Place);
  for (const auto& section : all) {
    const std::size_t begin = (end + alignment - 1) / alignment * alignment;
    places.push_back({begin, section.size()});
    end = begin + section.size();
  }
  std::string bytes(end, '\0');
  const auto put = [&](std::size_t at, std::span<const std::byte> part) {
    if (!part.empty()) std::memcpy(&bytes[at], part.data(), part.size());
  };
  put(sizeof(Header), std::as_bytes(std::span(places)));
  for (std::size_t i = 0; i < all.size(); ++i) put(places[i].begin, all[i]);
  const Header header{magic, byte_order, version, end, origin.map, all.size(), 0};
  put(0, std::as_bytes(std::span(&header, 1)));
  return with_checksum(std::move(bytes));
}

std::string with_checksum(std::string file) {
  if (file.size() < sizeof(Header)) return file;
  Header header;
  std::memcpy(&header, file.data(), sizeof(Header));
  header.file_size = file.size();
  header.checksum = checksum_of(header, std::as_bytes(std::span(file)).subspan(sizeof(Header)));
  std::memcpy(file.data(), &header, sizeof(Header));
  return file;
}

SavedIndex::SavedIndex(std::filesystem::path file, const IndexOrigin& origin) : file_(std::move(file)) {
  Mapping mapping = map_into_memory(file_);
  if (!mapping.bytes) fail("the index cannot be read: " + mapping.why_not);
  bytes_ = std::move(mapping.bytes);
  size_ = mapping.size;
  check(origin);
}

void SavedIndex::check(const IndexOrigin& origin) const {
  Header header;
  if (size_ >= sizeof(Header)) std::memcpy(&header, bytes_.get(), sizeof(Header));
  if (header.magic != magic) fail("this is not an index of a map");
  if (header.byte_order == other_byte_order) fail("the index was saved on a machine of another byte order");
  if (header.byte_order != byte_order) fail("the index is damaged");
  if (header.version != version) {
    fail(fmt::format("the index has version {} of the format; this program reads version {}", header.version,
                     version));
  }
  if (header.file_size != size_) {
    fail(fmt::format("the index is not whole: the file has {} bytes instead of {}", size_, header.file_size));
  }
  const std::span<const std::byte> rest = std::span(bytes_.get(), size_).subspan(sizeof(Header));
  if (header.checksum != checksum_of(header, rest) || header.sections > rest.size() / sizeof(Place)) {
    fail("the index is damaged: its content does not add up to its checksum");
  }
  if (header.map != origin.map) fail("the index belongs to another map");
  const std::string rule = text(0);
  if (rule != origin.rule) {
    fail("the index was built with other parameters: " + difference(rule, origin.rule));
  }
}

void SavedIndex::expect(const std::string& wanted) const {
  if (kind() != wanted) fail(fmt::format("the index is one of {} instead of {}", kind(), wanted));
}

void SavedIndex::expect_bins(std::span<const std::uint32_t> begins, std::size_t items) const {
  if (begins.empty() || begins.front() != 0 || begins.back() != items ||
      !std::is_sorted(begins.begin(), begins.end())) {
    fail("the index is damaged: its bins overlap");
  }
}

void SavedIndex::expect_finite(std::span<const float> values) const {
  // Squares of what is larger are no numbers any more.
  constexpr float largest = 1e9F;
  const auto is_good = [](float value) { return std::abs(value) <= largest; };
  if (!std::all_of(values.begin(), values.end(), is_good)) {
    fail("the index is damaged: it has points that lie nowhere");
  }
}

void SavedIndex::expect_fit(bool parts_fit) const {
  if (!parts_fit) fail("the index is damaged: its parts do not fit together");
}

void SavedIndex::expect_numbers_below(std::size_t points, std::span<const std::uint32_t> numbers) const {
  const auto largest = std::max_element(numbers.begin(), numbers.end());
  if (largest != numbers.end() && *largest >= points) fail(names_missing_points);
}

void SavedIndex::expect_below_or(std::uint32_t none, std::size_t points,
                                 std::span<const std::uint32_t> numbers) const {
  const auto is_good = [&](std::uint32_t number) { return number < points || number == none; };
  if (!std::all_of(numbers.begin(), numbers.end(), is_good)) fail(names_missing_points);
}

std::string SavedIndex::text(std::size_t section) const {
  const auto bytes = section_bytes(section, 1);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::span<const std::byte> SavedIndex::section_bytes(std::size_t i, std::size_t item) const {
  Header header;
  std::memcpy(&header, bytes_.get(), sizeof(Header));
  if (i >= header.sections) fail("the index is damaged: a section is missing");
  Place place;
  std::memcpy(&place, bytes_.get() + sizeof(Header) + i * sizeof(Place), sizeof(Place));
  const bool inside =
      place.begin % alignment == 0 && place.begin <= size_ && place.size <= size_ - place.begin;
  if (!inside || place.size % item != 0) fail("the index is damaged: a section has no place in it");
  return {bytes_.get() + place.begin, place.size};
}

void SavedIndex::fail(const std::string& what) const {
  throw ConfigError({{file_.string(), 0, 0,
                      fmt::format("{}; build it anew: glocal map index EXPERIMENT.yaml --force -o {}", what,
                                  file_.string())}});
}

}  // namespace glocal
