#include "sources/disturbed/chosen.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace glocal::disturbed {

void describe_chosen(ParamVisitor& v, Chosen& p, const std::vector<Kind>& kinds) {
  std::vector<std::string> names;
  for (const Kind& kind : kinds) names.emplace_back(kind.name);
  v.field("kind", p.kind, {.doc = "What goes wrong.", .choices = std::move(names), .required = true});
  v.field("level", p.level,
          {.doc = "How much of it: 1 is little, 5 is more than anybody expects to work. 0: the amount is "
                  "given.",
           .min = 0,
           .max = 5});
  v.field("amount", p.amount,
          {.doc = "How much of it, in the unit of the kind, in place of a level.", .above = 0.0});
  v.require((p.level > 0) != p.amount.has_value(), "level",
            "must be from 1 to 5, or an amount be given in its place");
  for (const Kind& kind : kinds) {
    if (kind.name != p.kind || !p.amount) continue;
    v.require(*p.amount <= kind.most, "amount", fmt::format("must be at most {} {}", kind.most, kind.unit));
    v.require(kind.least == 0 || (*p.amount >= kind.least && *p.amount == std::floor(*p.amount)), "amount",
              fmt::format("must be a whole number of at least {}", kind.least));
  }
}

}  // namespace glocal::disturbed
