#include "fast_dds_robot.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <condition_variable>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <mutex>
#include <stdexcept>

// Fast DDS 2.9 frees some of its own objects as others than it made: AddressSanitizer is to pass over that.
extern "C" const char* __asan_default_options();   // NOLINT: its name
extern "C" const char* __asan_default_options() {  // NOLINT
  return "new_delete_type_mismatch=0";
}

namespace glocal::test {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

/// A message as it travels.
class BytesType final : public dds::TopicDataType {
 public:
  explicit BytesType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 100'000;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<std::string*>(data);
    payload->encapsulation = CDR_LE;
    payload->length = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(payload->data, bytes.data(), bytes.size());
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<std::string*>(data)->assign(reinterpret_cast<const char*>(payload->data), payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<std::string*>(data)->size()); };
  }
  void* createData() override { return new std::string; }
  void deleteData(void* data) override { delete static_cast<std::string*>(data); }
  bool getKey(void* /*data*/, rtps::InstanceHandle_t* /*handle*/, bool /*force_md5*/) override {
    return false;
  }
};

template <class Qos>
Qos with(Qos qos, const RobotQos& wanted) {
  qos.reliability().kind = wanted.reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
  qos.durability().kind =
      wanted.transient_local ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = wanted.depth;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  return qos;
}

/// What is lost or kept is sent again when receivers are told of it: usually every 3 s.
dds::DataWriterQos often(dds::DataWriterQos qos) {
  qos.reliable_writer_qos().times.heartbeatPeriod = {0, 100'000'000};
  return qos;
}

class Matches final : public dds::DataWriterListener {
 public:
  void on_publication_matched(dds::DataWriter* /*writer*/,
                              const dds::PublicationMatchedStatus& info) override {
    const std::lock_guard lock(mutex_);
    count_ = info.current_count;
    changed_.notify_all();
  }
  bool reach(int count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, long_enough, [&] { return count_ >= count; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  int count_ = 0;
};

template <class Made>
Made* made(Made* entity) {
  if (entity == nullptr) throw std::runtime_error("Fast DDS makes no such entity");
  return entity;
}

/// A topic of the robot's, as long as it is sent or received.
class OpenTopic {
 public:
  OpenTopic(dds::DomainParticipant& participant, const std::string& name, const std::string& type)
      : participant_(participant) {
    dds::TypeSupport(new BytesType(type)).register_type(&participant);
    topic_ = made(participant.create_topic(name, type, dds::TOPIC_QOS_DEFAULT));
  }
  OpenTopic(const OpenTopic&) = delete;
  OpenTopic& operator=(const OpenTopic&) = delete;
  ~OpenTopic() { participant_.delete_topic(topic_); }
  [[nodiscard]] dds::DomainParticipant& participant() const { return participant_; }
  [[nodiscard]] dds::Topic* get() const { return topic_; }

 private:
  dds::DomainParticipant& participant_;
  dds::Topic* topic_;
};

class FastSender final : public Robot::Sender {
 public:
  FastSender(dds::DomainParticipant& participant, const std::string& topic, const std::string& type,
             const RobotQos& qos)
      : topic_(participant, topic, type),
        publisher_(made(participant.create_publisher(dds::PUBLISHER_QOS_DEFAULT))),
        writer_(made(publisher_->create_datawriter(
            topic_.get(), often(with(dds::DATAWRITER_QOS_DEFAULT, qos)), &matches_))) {}
  ~FastSender() override {
    publisher_->delete_datawriter(writer_);
    topic_.participant().delete_publisher(publisher_);
  }
  void send(std::string_view bytes) override {
    std::string message(bytes);
    if (!writer_->write(&message)) throw std::runtime_error("Fast DDS does not send");
  }
  bool has_receivers(int count) override { return matches_.reach(count); }

 private:
  OpenTopic topic_;
  Matches matches_;
  dds::Publisher* publisher_;
  dds::DataWriter* writer_;
};

class FastReceiver final : public Robot::Receiver {
 public:
  FastReceiver(dds::DomainParticipant& participant, const std::string& topic, const std::string& type,
               const RobotQos& qos)
      : topic_(participant, topic, type),
        subscriber_(made(participant.create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT))),
        reader_(made(subscriber_->create_datareader(topic_.get(), with(dds::DATAREADER_QOS_DEFAULT, qos)))) {}
  ~FastReceiver() override {
    subscriber_->delete_datareader(reader_);
    topic_.participant().delete_subscriber(subscriber_);
  }
  std::optional<std::string> receive(std::chrono::milliseconds longest) override {
    const auto until = std::chrono::steady_clock::now() + longest;
    std::string bytes;
    dds::SampleInfo info;
    while (std::chrono::steady_clock::now() < until) {
      if (reader_->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK && info.valid_data)
        return bytes;
      reader_->wait_for_unread_message({0, 20'000'000});
    }
    return std::nullopt;
  }

 private:
  OpenTopic topic_;
  dds::Subscriber* subscriber_;
  dds::DataReader* reader_;
};

}  // namespace

struct Robot::Participant {
  dds::DomainParticipant* entity = nullptr;
};

Robot::Robot(int domain) {
  dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
  const auto transport = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  transport->interfaceWhiteList = {"127.0.0.1"};
  transport->maxInitialPeersRange = 4;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports = {transport};
  rtps::Locator_t here;
  rtps::IPLocator::setIPv4(here, "127.0.0.1");
  qos.wire_protocol().builtin.initialPeersList.push_back(here);
  participant_ = std::make_unique<Participant>();
  participant_->entity = made(dds::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<dds::DomainId_t>(domain), qos));
}

Robot::~Robot() {
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant_->entity);
}

std::unique_ptr<Robot::Sender> Robot::sender(const std::string& topic, const std::string& type,
                                             const RobotQos& qos) {
  return std::make_unique<FastSender>(*participant_->entity, topic, type, qos);
}

std::unique_ptr<Robot::Receiver> Robot::receiver(const std::string& topic, const std::string& type,
                                                 const RobotQos& qos) {
  return std::make_unique<FastReceiver>(*participant_->entity, topic, type, qos);
}

}  // namespace glocal::test
