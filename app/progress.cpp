#include "app/progress.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>

#include "app/interrupts.hpp"
#include "app/standard_streams.hpp"

namespace glocal::app {
namespace {

constexpr std::chrono::milliseconds between_bars{100};
constexpr std::chrono::minutes between_lines{1};

}  // namespace

std::string time_left(std::optional<double> left_s) {
  if (!left_s) return "";
  if (*left_s < 99.0) return fmt::format(", about {:.0f} s left", *left_s);
  if (*left_s < 99.0 * 60.0) return fmt::format(", about {:.0f} min left", *left_s / 60.0);
  return fmt::format(", about {:.1f} h left", *left_s / 3600.0);
}

Progress::Progress(bool shown, std::size_t trials)
    : shown_(shown), on_terminal_(isatty(STDERR_FILENO) == 1), trials_(static_cast<double>(trials)) {}

Progress::~Progress() {
  if (shown_ && on_terminal_) say_over("");
}

void Progress::begin(const std::string& what) {
  const std::lock_guard lock(mutex_);
  what_ = what.empty() ? "" : what + ", ";
}

void Progress::step(std::size_t trial, std::size_t step, double share, const char* verdict) {
  const std::lock_guard lock(mutex_);
  running_[trial] = share;
  const auto now = Clock::now();
  if (!shown_ || now - last_ < (on_terminal_ ? Clock::duration(between_bars) : between_lines)) return;
  last_ = now;
  const double done = share_done();
  const std::string left = time_left(seconds_left(done));
  if (!on_terminal_) {
    spdlog::info("{}{} of {:.0f} trials done{}", what_, finished_, trials_, left);
    return;
  }
  say_over(fmt::format("{} {} of {:.0f}{}  {}trial {}, step {}  {}", text_bar(done), finished_, trials_, left,
                       what_, trial, step, verdict));
}

void Progress::finish(std::size_t trial) {
  const std::lock_guard lock(mutex_);
  running_.erase(trial);
  ++finished_;
}

void Progress::skip(std::size_t trials) {
  const std::lock_guard lock(mutex_);
  trials_ -= static_cast<double>(trials);
}

RunProgress Progress::now() {
  const std::lock_guard lock(mutex_);
  return {finished_, static_cast<std::size_t>(trials_), seconds_left(share_done())};
}

/// Of all trials, with what is done of those that are running.
double Progress::share_done() const {
  double done = static_cast<double>(finished_);
  for (const auto& [trial, share] : running_) done += share;
  return std::min(1.0, done / trials_);
}

/// None until it can be told.
std::optional<double> Progress::seconds_left(double share_done) const {
  const double passed_s = std::chrono::duration<double>(Clock::now() - start_).count();
  if (passed_s < 2.0 || share_done < 0.01) return std::nullopt;
  return passed_s * (1.0 - share_done) / share_done;
}

RunnerCallbacks Waiting::callbacks() {
  return {.counted = [this](std::size_t trials) { progress_.emplace(!quiet_, trials); },
          .begin = [this](const LoadedVariant& variant) { begin(variant); },
          .trials = {[this](std::size_t trial, const StepRecord& record, const Localizer& now) {
                       step(trial, record, now);
                     },
                     [this](const TrialRecord& record) { finish(record); }, is_interrupted},
          .note =
              [this](const std::string& text) {
                if (!quiet_) spdlog::info(text);
              },
          .warn = warn};
}

void Waiting::begin(const LoadedVariant& variant) {
  progress_->begin(variant.name);
  progress_->skip(variant.finished);
  longest_trial_ = std::min(variant.loaded.drive.samples.size(), step_limit(variant.experiment.trials));
  if (live_ != nullptr) live_->begin(variant.name, variant.folder, variant.settings, variant.loaded);
}

void Waiting::step(std::size_t trial, const StepRecord& record, const Localizer& now) {
  const std::size_t step = record.result.step;
  progress_->step(trial, step, static_cast<double>(step) / static_cast<double>(longest_trial_),
                  to_string(record.result.verdict.kind));
  if (live_ != nullptr) live_->step(trial, record, now.local_map().points, progress_->now());
}

void Waiting::finish(const TrialRecord& record) {
  progress_->finish(record.trial);
  if (live_ != nullptr) live_->finish(record, progress_->now());
  if (record.outcome == Outcome::failed)
    spdlog::error("trial {} failed in step {}: {}", record.trial, record.records.size(), record.why);
}

}  // namespace glocal::app
