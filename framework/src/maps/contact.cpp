#include "glocal/contact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "config/writer.hpp"

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

void register_contact_indexes(ContactIndexes& indexes) {
  indexes.add<BitsetContact>(
      "bitset",
      "Bits on a grid of epsilon / 4, or of epsilon / 2 on planar maps of more than 25 hectares: "
      "constant time, exact up to half a voxel.",
      stable_since("0.1.0"));
  indexes.add<KdTreeContact>("kd_tree", "Exact, and twenty-five times slower.", stable_since("0.1.0"));
}

namespace {

/// Calls `use` with the registry a choice is from.
template <class Use>
auto with_indexes(const ContactIndexes* indexes, Use use) {
  if (indexes != nullptr) return use(*indexes);
  ContactIndexes built_in("contact_index");
  register_contact_indexes(built_in);
  return use(built_in);
}

}  // namespace

void ContactChoice::describe_as(const char* name, ParamVisitor& v) {
  with_indexes(indexes_, [&](const ContactIndexes& indexes) {
    v.strategy(name, choice_, indexes, {.doc = "How contact with the map is found."});
  });
}

void describe_contact_epsilon(ParamVisitor& v, std::optional<double>& epsilon) {
  v.field(
      "contact_epsilon", epsilon,
      {.doc =
           "Distance at which a point is in contact with the map (epsilon of eq. 4); auto takes that of the "
           "localizer.",
       .unit = "m",
       .above = 0.0,
       .audience = Audience::expert});
}

std::shared_ptr<const ContactIndex> contact_index(const GlobalMap& map, const ContactChoice& choice,
                                                  double epsilon, int threads) {
  const std::string params = choice.choice_.params ? write_yaml(*choice.choice_.params) : "";
  const std::string key = fmt::format("{} {} {}", choice.choice_.name, epsilon, params);
  const auto owner = map.index<std::unique_ptr<ContactIndex>>(key, [&] {
    return with_indexes(choice.indexes_, [&](const ContactIndexes& indexes) {
      return indexes.make(choice.choice_, {&map.points(), epsilon, threads});
    });
  });
  return {owner, owner->get()};
}

}  // namespace glocal
