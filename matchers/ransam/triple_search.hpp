// What may be asked of a search by triples of points, in the plane and in space.
#pragma once

#include <optional>
#include <string>

#include "glocal/contact.hpp"
#include "glocal/params.hpp"
#include "matchers/common/quality.hpp"

namespace glocal::ransam {

struct TripleSearch {
  int iterations = 200000;
  std::optional<double> contact_epsilon = {};
  double relation_cell = 0.10;
  double min_side = 0.3;
  double min_height = 0.1;
  double local_radius = 0.0;
  int extrapolation_batch = 8;
  double extrapolation_z = 1.96;
  std::string extrapolation = "interval";
  ContactChoice contact = "bitset";
  bool neighbour_cells = false;
  /// Of more, those that mean nearly the same pose (5 cm and 2 degrees, or coarser until they fit) become
  /// one, which counts as many. Not in YAML.
  int max_hypotheses = 10000;
};
void describe(ParamVisitor& v, TripleSearch& p);
/// Which triples are drawn and when points are in contact; the rest is as it stands.
void describe_triples(ParamVisitor& v, TripleSearch& p);

[[nodiscard]] ExtrapolationRule extrapolation_rule(const TripleSearch& p);

}  // namespace glocal::ransam
