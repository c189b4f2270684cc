// Messages on their way out.
#pragma once

#include <dds/ddsi/ddsi_serdata.h>

#include <string_view>

namespace glocal::ros2_plugin {

/// A message as bytes, for dds_writecdr(): there Cyclone makes one of the writer's type of it, and refuses it
/// if it is none. The bytes must stay until then. To be owned by who calls; dds_writecdr() takes it over.
[[nodiscard]] ddsi_serdata* outgoing(std::string_view bytes);

}  // namespace glocal::ros2_plugin
