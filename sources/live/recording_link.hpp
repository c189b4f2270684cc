// A recording in place of a robot.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/message_link.hpp"
#include "sources/bags/recording.hpp"

namespace glocal::live {

/// Gives a recording's messages in the order of their receipt, those of ROS 1 as ROS 2 has them; what is
/// published goes nowhere.
class RecordingLink final : public MessageLink {
 public:
  struct Params {
    FilePath path;
    bool in_real_time = false;
  };

  /// Throws ConfigError where Recording does.
  RecordingLink(const Params& params, const SourceSetup& setup);

  /// Messages that have gone by do not come any more. Throws ConfigError for a type that nobody here knows.
  void subscribe(const LiveTopic& topic, Delivery delivery) override;
  [[nodiscard]] std::optional<LiveMessage> next(std::chrono::milliseconds longest) override;
  [[nodiscard]] bool is_live() const override { return is_live_; }
  [[nodiscard]] bool has_ended() const override { return has_ended_; }
  void publish(const LiveTopic& topic, Delivery delivery, std::string_view bytes) override;
  [[nodiscard]] std::vector<LiveTopic> topics() override;

 private:
  using Clock = std::chrono::steady_clock;

  /// As ROS 2 has it; none where nobody knows how, or it is damaged.
  std::optional<std::string> cdr_of(const bags::RecordedMessage& message);

  bool is_live_, has_warned_ = false;
  Warn warn_;
  bags::Recording recording_;
  std::set<std::string> asked_for_;
  std::optional<LiveMessage> waiting_;  ///< Its time has not come.
  bool has_ended_ = false;
  std::optional<Clock::time_point> begun_;
  std::int64_t first_ns_ = 0;
};
void describe(ParamVisitor& v, RecordingLink::Params& p);

}  // namespace glocal::live
