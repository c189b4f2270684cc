// A link whose messages are written down as they come.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "glocal/message_link.hpp"
#include "sources/bags/mcap_writer.hpp"

namespace glocal::live {

/// What comes over another link, and what is published on it, goes to an MCAP file, too: replayed, it gives
/// the same drive.
class RecordedLink final : public MessageLink {
 public:
  /// Throws ConfigError if the file is there already, or cannot be written.
  RecordedLink(std::shared_ptr<MessageLink> link, const std::filesystem::path& file);
  /// Ends the file; what could not be written is lost then.
  ~RecordedLink() override;

  void subscribe(const LiveTopic& topic, Delivery delivery) override { link_->subscribe(topic, delivery); }
  [[nodiscard]] std::optional<LiveMessage> next(std::chrono::milliseconds longest) override;
  [[nodiscard]] bool is_live() const override { return link_->is_live(); }
  [[nodiscard]] bool has_ended() const override { return link_->has_ended(); }
  void publish(const LiveTopic& topic, Delivery delivery, std::string_view bytes) override;
  [[nodiscard]] std::vector<LiveTopic> topics() override { return link_->topics(); }

 private:
  void write(const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes);

  std::shared_ptr<MessageLink> link_;
  std::string name_;
  std::ofstream file_;
  bags::McapWriter writer_;
  std::map<std::string, std::uint16_t> channels_;  ///< By topic.
  std::int64_t last_ns_ = 0;
};

}  // namespace glocal::live
