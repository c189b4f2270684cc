#include "outgoing.hpp"

namespace glocal::ros2_plugin {
namespace {

/// As C inherits.
struct Outgoing {
  ddsi_serdata base;
  std::string_view bytes;
};

const std::string_view& bytes_of(const ddsi_serdata* message) {
  return reinterpret_cast<const Outgoing*>(message)->bytes;
}

std::uint32_t size(const ddsi_serdata* message) {
  return static_cast<std::uint32_t>(bytes_of(message).size());
}

ddsi_serdata* lend(const ddsi_serdata* message, std::size_t offset, std::size_t size, ddsrt_iovec_t* part) {
  // Cyclone only reads what it borrows.
  part->iov_base = const_cast<char*>(bytes_of(message).data() + offset);
  part->iov_len = size;
  return ddsi_serdata_ref(message);
}

void take_back(ddsi_serdata* message, const ddsrt_iovec_t* /*part*/) {
  ddsi_serdata_unref(message);
}

void free_message(ddsi_serdata* message) {
  delete reinterpret_cast<Outgoing*>(message);
}

/// Of no domain: nothing is written or read as this type.
const ddsi_sertype& bytes_type() {
  static const ddsi_serdata_ops message_ops = [] {
    ddsi_serdata_ops ops{};
    ops.get_size = size;
    ops.to_ser_ref = lend;
    ops.to_ser_unref = take_back;
    ops.free = free_message;
    return ops;
  }();
  static const ddsi_sertype_ops type_ops = [] {
    ddsi_sertype_ops ops{};
    ops.version = ddsi_sertype_v0;
    return ops;
  }();
  static const ddsi_sertype type = [] {
    ddsi_sertype made{};
    made.ops = &type_ops;
    made.serdata_ops = &message_ops;
    return made;
  }();
  return type;
}

}  // namespace

ddsi_serdata* outgoing(std::string_view bytes) {
  auto* message = new Outgoing{{}, bytes};
  ddsi_serdata_init(&message->base, &bytes_type(), SDK_DATA);
  return &message->base;
}

}  // namespace glocal::ros2_plugin
