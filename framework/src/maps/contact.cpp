#include "glocal/contact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace glocal {

ContactIndex::Count ContactIndex::count_while(const Points& points, std::size_t begin, std::size_t n,
                                              std::size_t batch, std::span<const std::uint32_t> least,
                                              const Transform& map_from_points) const {
  Count result;
  for (const std::uint32_t enough : least) {
    const std::size_t here = std::min(batch, n - result.looked_at);
    result.in_contact += count(points, begin + result.looked_at, here, map_from_points);
    result.looked_at += here;
    if (result.in_contact < enough) break;
  }
  return result;
}

void ContactIndex::count_at_most(const Points& /*points*/, std::size_t n, const MotionBatch& /*motions*/,
                                 std::size_t size, const BatchColumn& /*begins*/,
                                 BatchColumn& at_most) const {
  std::fill_n(at_most.begin(), size, static_cast<std::uint32_t>(n));
}

std::vector<std::string> contact_index_names() {
  return {"bitset", "kd_tree"};
}

std::shared_ptr<const ContactIndex> contact_index(const GlobalMap& map, const std::string& name,
                                                  double epsilon) {
  const std::string key = fmt::format("{}", epsilon);
  if (name == "bitset")
    return map.index<BitsetContact>(key, [&] { return BitsetContact(map.points(), epsilon); });
  if (name == "kd_tree")
    return map.index<KdTreeContact>(key, [&] { return KdTreeContact(map.points(), epsilon); });
  throw std::invalid_argument("no contact index '" + name + "'");
}

}  // namespace glocal
