// A matcher that throws in the third step of its second trial.
#include <stdexcept>

#include "glocal/plugin.hpp"

namespace {

class Moody final : public glocal::Matcher {
 public:
  struct Params {};
  explicit Moody(const Params& /*params*/) {}
  glocal::MatchResult match(const glocal::MatchRequest& /*request*/, glocal::Rng& /*rng*/) override {
    if (trial_ == 2 && ++step_ == 3) throw std::runtime_error("out of mood");
    return {};
  }
  void reset() override {
    ++trial_;
    step_ = 0;
  }

 private:
  int trial_ = 0;
  int step_ = 0;
};
void describe(glocal::ParamVisitor& /*v*/, Moody::Params& /*p*/) {}

}  // namespace

GLOCAL_PLUGIN("moody", "1", catalog) {
  catalog.matchers.add<Moody>("moody", "Throws in the middle of a step.");
}
