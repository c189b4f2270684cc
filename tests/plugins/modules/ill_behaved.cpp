// A matcher that does what no matcher should.
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>

#include "glocal/parallel.hpp"
#include "glocal/plugin.hpp"

namespace {

using namespace glocal;

class IllBehaved final : public Matcher {
 public:
  struct Params {
    std::string how = "nan";
    double stamp = -1.0;
    std::string once;
  };
  explicit IllBehaved(const Params& params) : params_(params), how_(params.how) {}

  MatchResult match(const MatchRequest& request, Rng& /*rng*/) override {
    if (params_.stamp >= 0.0 && request.latest.stamp != params_.stamp) return {};
    if (!params_.once.empty()) {
      if (std::filesystem::exists(params_.once)) return {};
      const std::ofstream mark(params_.once);
    }
    if (how_ == "crash") std::raise(SIGSEGV);
    if (how_ == "crash_in_a_thread")
      parallel_for(2, 100, [](std::size_t i) {
        if (i == 99) std::raise(SIGSEGV);
      });
    if (how_ == "abort") std::terminate();
    if (how_ == "exit") std::exit(0);
    if (how_ == "hang") std::this_thread::sleep_for(std::chrono::hours(1));
    if (how_ == "fork") {
      static_cast<void>(fork());
      return {};
    }
    if (how_ == "fork_and_go_on" && fork() == 0) parallel_for(2, 100, [](std::size_t) {});
    if (how_ == "latin1") throw std::runtime_error("T\xfcr zu");
    return {{Hypothesis::by_contact(Pose2{std::numeric_limits<double>::quiet_NaN(), 0, 0}, 1.0)}, 1, 1};
  }
  void reset() override {}

 private:
  Params params_;
  std::string how_;
};
void describe(ParamVisitor& v, IllBehaved::Params& p) {
  v.field("how", p.how, {.doc = "What it does wrong."});
  v.field("stamp", p.stamp, {.doc = "When it does; negative: always.", .unit = "s"});
  v.field("once", p.once, {.doc = "File that says that it has done it, and does no more."});
}

}  // namespace

GLOCAL_PLUGIN("ill_behaved", "1", catalog) {
  catalog.matchers.add<IllBehaved>("ill_behaved", "Does what no matcher should.");
}
