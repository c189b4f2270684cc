#include "ros2_link.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <tuple>

#include "glocal/error.hpp"
#include "names.hpp"
#include "outgoing.hpp"

namespace glocal::ros2_plugin {
namespace {

/// Ports of UDP end there.
constexpr int last_domain = 232;

[[noreturn]] void refuse(const std::string& why) {
  throw ConfigError("", why);
}

dds_domainid_t domain_of(const Ros2Link::Params& params) {
  if (params.domain) return static_cast<dds_domainid_t>(*params.domain);
  const char* set = std::getenv("ROS_DOMAIN_ID");
  const std::string_view text = set == nullptr ? "" : set;
  if (text.empty()) return 0;
  int domain = -1;
  const auto [end, error] = std::from_chars(text.begin(), text.end(), domain);
  if (error != std::errc() || end != text.end() || domain < 0 || domain > last_domain) {
    refuse("ROS_DOMAIN_ID is '" + std::string(text) + "'; it must be a whole number from 0 to " +
           std::to_string(last_domain) + ": set it as on the robot, or give 'domain'");
  }
  return static_cast<dds_domainid_t>(domain);
}

/// Cyclone says in its log what is wrong with its configuration.
dds_entity_t begun(dds_domainid_t domain, Mailbox& log) {
  const dds_entity_t participant = dds_create_participant(domain, nullptr, nullptr);
  if (participant > 0) return participant;
  std::string why = "DDS cannot begin in the domain " + std::to_string(domain) + " (" +
                    dds_strretcode(-participant) +
                    "): see that there is a network, and that CYCLONEDDS_URI, if it is set, fits it";
  for (const std::string& note : log.take_notes().notes) why += "\n" + note;
  refuse(why);
}

/// For calls that fail only for want of memory.
dds_entity_t made(dds_entity_t entity, const char* what) {
  if (entity < 0) throw RunError(std::string("DDS cannot make ") + what + ": " + dds_strretcode(-entity));
  return entity;
}

struct FreeQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, FreeQos>;

struct FreeListener {
  void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};
using Listener = std::unique_ptr<dds_listener_t, FreeListener>;

Qos qos_of(Delivery delivery, int depth) {
  Qos qos(dds_create_qos());
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_reliability(qos.get(),
                       delivery == Delivery::newest ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE,
                       DDS_MSECS(100));
  dds_qset_durability(qos.get(),
                      delivery == Delivery::kept ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  const dds_data_representation_id_t as_ros = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &as_ros);
  return qos;
}

/// Who receives may ask for no more than who sends offers.
std::string mismatch(dds_qos_policy_id_t policy) {
  if (policy == DDS_RELIABILITY_QOS_POLICY_ID)
    return "reliability: it is sent as best effort, and asked for as reliable";
  if (policy == DDS_DURABILITY_QOS_POLICY_ID)
    return "durability: it is sent as volatile, and asked for as transient local";
  return "policy " + std::to_string(policy) + " of DDS";
}

void on_message(dds_entity_t reader, void* box_of_topic) {
  auto& box = *static_cast<Mailbox::Box*>(box_of_topic);
  std::array<ddsi_serdata*, 16> taken{};
  std::array<dds_sample_info_t, 16> infos{};
  dds_return_t count = 0;
  while ((count = dds_takecdr(reader, taken.data(), taken.size(), infos.data(), DDS_ANY_STATE)) > 0) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      Received message(taken[i]);
      // Others tell that a sender has gone.
      if (infos[i].valid_data) box.mailbox.put(box, std::move(message));
    }
  }
}

void on_unheard(dds_entity_t /*reader*/, const dds_requested_incompatible_qos_status_t status,
                void* box_of_topic) {
  auto& box = *static_cast<Mailbox::Box*>(box_of_topic);
  box.mailbox.note("a sender of " + box.topic.name + " is not heard (" +
                   mismatch(static_cast<dds_qos_policy_id_t>(status.last_policy_id)) + ")");
}

void on_unreached(dds_entity_t writer, const dds_offered_incompatible_qos_status_t status, void* mailbox) {
  std::array<char, 300> name{};
  dds_get_name(dds_get_topic(writer), name.data(), name.size());
  static_cast<Mailbox*>(mailbox)->note(
      "a receiver of " + ros_topic(name.data()).value_or("") + " hears nothing (" +
      mismatch(static_cast<dds_qos_policy_id_t>(status.last_policy_id)) + ")");
}

void on_senders(dds_entity_t /*reader*/, void* mailbox) {
  static_cast<Mailbox*>(mailbox)->note_senders();
}

}  // namespace

void describe(ParamVisitor& v, Ros2Link::Params& p) {
  v.field("domain", p.domain,
          {.doc = "The robot's domain, a whole number. `auto` is that of the environment's ROS_DOMAIN_ID, 0 "
                  "without it.",
           .min = 0.0,
           .max = last_domain});
  v.require(!p.domain || *p.domain == std::floor(*p.domain), "domain", "must be a whole number");
}

Ros2Link::Ros2Link(const Params& params, const SourceSetup& setup)
    : warn_(setup.warn),
      log_([this](const std::string& line) { mailbox_.note("DDS: " + line); }),
      participant_(begun(domain_of(params), mailbox_)) {
  const Listener listener(dds_create_listener(&mailbox_));
  dds_lset_data_available(listener.get(), on_senders);
  senders_reader_ = made(
      dds_create_reader(participant_.handle(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, listener.get()),
      "a reader of what others send");
}

dds_entity_t Ros2Link::topic_of(const LiveTopic& topic) {
  const std::string name = dds_topic(topic.name);
  const dds_topic_descriptor_t& layout = layout_of(topic);
  if (const auto known = topics_.find(topic.name); known != topics_.end()) {
    if (known->second.type == topic.type) return known->second.handle;
    refuse("the topic '" + topic.name + "' is of the type " + known->second.type +
           " already; it cannot be of " + topic.type + ", too");
  }
  const dds_entity_t handle =
      made(dds_create_topic(participant_.handle(), &layout, name.c_str(), nullptr, nullptr), "a topic");
  topics_[topic.name] = {topic.type, handle};
  return handle;
}

void Ros2Link::subscribe(const LiveTopic& topic, Delivery delivery) {
  const dds_entity_t handle = topic_of(topic);
  if (!subscribed_.insert(topic.name).second) return;
  constexpr std::size_t most_bytes = 64'000'000;
  const bool newest = delivery == Delivery::newest;
  // One box for all senders: of several, each has its last message in it.
  Mailbox::Box& box = mailbox_.add(topic, {newest ? 5 : most_bytes, most_bytes});
  const Listener listener(dds_create_listener(&box));
  dds_lset_data_available(listener.get(), on_message);
  dds_lset_requested_incompatible_qos(listener.get(), on_unheard);
  const Qos qos = qos_of(delivery, newest ? 5 : 100);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  made(dds_create_reader(participant_.handle(), handle, qos.get(), listener.get()), "a reader");
  mailbox_.note_senders();
}

std::optional<LiveMessage> Ros2Link::next(std::chrono::milliseconds longest) {
  using namespace std::chrono;
  const auto until = steady_clock::now() + std::min<milliseconds>(longest, hours(24));
  for (;;) {
    Mailbox::News news = mailbox_.take(until);
    tell(news);
    if (news.message || steady_clock::now() >= until) return std::move(news.message);
  }
}

dds_entity_t Ros2Link::writer_of(const LiveTopic& topic, Delivery delivery) {
  const dds_entity_t handle = topic_of(topic);
  dds_entity_t& writer = writers_[topic.name];
  if (writer == 0) {
    const Listener listener(dds_create_listener(&mailbox_));
    dds_lset_offered_incompatible_qos(listener.get(), on_unreached);
    const std::array<int, 3> depths = {5, 100, 1};
    const Qos qos = qos_of(delivery, depths[static_cast<std::size_t>(delivery)]);
    writer = made(dds_create_writer(participant_.handle(), handle, qos.get(), listener.get()), "a writer");
  }
  return writer;
}

void Ros2Link::advertise(const LiveTopic& topic, Delivery delivery) {
  static_cast<void>(writer_of(topic, delivery));
}

void Ros2Link::publish(const LiveTopic& topic, Delivery delivery, std::string_view bytes) {
  const dds_entity_t writer = writer_of(topic, delivery);
  constexpr std::size_t header = 4;
  const dds_return_t sent =
      bytes.size() < header ? DDS_RETCODE_BAD_PARAMETER : dds_writecdr(writer, outgoing(bytes));
  if (sent == DDS_RETCODE_TIMEOUT) {
    tell_once("receivers of " + topic.name + " do not keep up: messages to them are lost");
  } else if (sent != DDS_RETCODE_OK) {
    throw RunError(topic.name + ": the " + std::to_string(bytes.size()) +
                   " bytes are no message of the type " + topic.type + " (" + dds_strretcode(-sent) + ")");
  }
  tell(mailbox_.take_notes());
}

std::vector<LiveTopic> Ros2Link::topics() {
  tell(mailbox_.take_notes());
  std::vector<LiveTopic> found;
  for (const auto& [sender, topic] : senders_) found.push_back(topic);
  std::ranges::sort(found, {}, [](const LiveTopic& t) { return std::tie(t.name, t.type); });
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

void Ros2Link::tell(const Mailbox::News& news) {
  for (const std::string& note : news.notes) tell_once(note);
  if (!news.senders) return;
  update_senders();
  for (const auto& [sender, topic] : senders_) {
    if (!subscribed_.contains(topic.name)) continue;
    const std::string& asked = topics_.at(topic.name).type;
    if (topic.type == asked) continue;
    tell_once("a sender of " + topic.name + " is not heard: it sends " + topic.type + ", and " + asked +
              " is asked for");
  }
}

void Ros2Link::tell_once(const std::string& sentence) {
  constexpr std::size_t most = 100;
  if (told_.size() < most && told_.insert(sentence).second) warn_(sentence);
}

void Ros2Link::update_senders() {
  dds_guid_t self{};
  dds_get_guid(participant_.handle(), &self);
  void* sample = nullptr;
  dds_sample_info_t info{};
  while (dds_take(senders_reader_, &sample, &info, 1, 1) > 0) {
    const auto& sender = *static_cast<const dds_builtintopic_endpoint_t*>(sample);
    const bool goes_on = info.valid_data && info.instance_state == DDS_ALIVE_INSTANCE_STATE;
    if (!goes_on) {
      senders_.erase(info.instance_handle);
    } else if (std::memcmp(&sender.participant_key, &self, sizeof self) != 0) {
      if (const auto name = ros_topic(sender.topic_name))
        senders_[info.instance_handle] = {*name, ros_type(sender.type_name)};
    }
    dds_return_loan(senders_reader_, &sample, 1);
    sample = nullptr;
  }
}

}  // namespace glocal::ros2_plugin
