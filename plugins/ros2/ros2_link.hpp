// Topics of ROS 2.
#pragma once

#include <dds/dds.h>

#include <map>
#include <optional>
#include <set>
#include <string>

#include "glocal/catalog.hpp"
#include "glocal/message_link.hpp"
#include "glocal/params.hpp"
#include "log_lines.hpp"
#include "mailbox.hpp"

namespace glocal::ros2_plugin {

/// Something of DDS that ends with all that belongs to it.
class Entity {
 public:
  explicit Entity(dds_entity_t handle) : handle_(handle) {}
  Entity(const Entity&) = delete;
  Entity& operator=(const Entity&) = delete;
  ~Entity() { dds_delete(handle_); }
  [[nodiscard]] dds_entity_t handle() const { return handle_; }

 private:
  dds_entity_t handle_;
};

/// Takes part in a domain of DDS as a node of ROS 2 does, by Cyclone DDS. Networks are chosen by Cyclone, or
/// by whoever sets CYCLONEDDS_URI. What it sends itself it does not hear.
///
/// Messages wait for next() in the order in which they were received, whatever their topic: the newest 5 of a
/// topic with Delivery::newest, 64 MB of others. What cannot be a message of its type is dropped.
class Ros2Link final : public MessageLink {
 public:
  struct Params {
    std::optional<double> domain = {};
  };

  /// Throws ConfigError for a ROS_DOMAIN_ID that is no domain, and where DDS cannot begin, as without a
  /// network.
  Ros2Link(const Params& params, const SourceSetup& setup);

  /// Of a topic that was subscribed to before, the delivery stays. Throws ConfigError, too, for what is no
  /// name of a topic, and for a topic that has another type already.
  void subscribe(const LiveTopic& topic, Delivery delivery) override;
  /// Tells the user, once each, of senders and receivers that cannot be matched, too.
  [[nodiscard]] std::optional<LiveMessage> next(std::chrono::milliseconds longest) override;
  /// Throws ConfigError as subscribe().
  void advertise(const LiveTopic& topic, Delivery delivery) override;
  /// Does not wait for receivers: those that have not found the topic yet, some 0.1 s after it was
  /// advertised or its first message, miss what is not kept. Waits for at most 0.1 s where receivers do not
  /// keep up. Throws RunError for bytes that are no message of this type, ConfigError as subscribe().
  void publish(const LiveTopic& topic, Delivery delivery, std::string_view bytes) override;
  /// It takes up to some seconds until all are known.
  [[nodiscard]] std::vector<LiveTopic> topics() override;

 private:
  dds_entity_t topic_of(const LiveTopic& topic);
  dds_entity_t writer_of(const LiveTopic& topic, Delivery delivery);
  void tell(const Mailbox::News& news);
  void tell_once(const std::string& sentence);
  void update_senders();

  struct KnownTopic {
    std::string type;
    dds_entity_t handle;
  };

  Warn warn_;
  std::set<std::string> told_;
  Mailbox mailbox_;
  std::map<std::string, KnownTopic> topics_;
  std::set<std::string> subscribed_;
  std::map<std::string, dds_entity_t> writers_;
  std::map<dds_instance_handle_t, LiveTopic> senders_;  ///< All but this link.
  dds_entity_t senders_reader_ = 0;
  LogLines log_;
  Entity participant_;  ///< The last one: once it has gone, no thread uses the others.
};
void describe(ParamVisitor& v, Ros2Link::Params& p);

}  // namespace glocal::ros2_plugin
