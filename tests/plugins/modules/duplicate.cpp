// Registers a name that is taken.
#include "glocal/plugin.hpp"

namespace {

class Nothing final : public glocal::Matcher {
 public:
  struct Params {};
  explicit Nothing(const Params& /*params*/) {}
  glocal::MatchResult match(const glocal::MatchRequest& /*request*/, glocal::Rng& /*rng*/) override {
    return {};
  }
  void reset() override {}
};
void describe(glocal::ParamVisitor& /*v*/, Nothing::Params& /*p*/) {}

}  // namespace

GLOCAL_PLUGIN("copycat", "2.0", catalog) {
  catalog.matchers.add<Nothing>("ransam", "Not the real one.");
}
