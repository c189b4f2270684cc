# Debian's cross compiler for arm64, and its libraries beside the machine's own (scripts/setup --arm64). What is built runs under QEMU.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static)
set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
# What pkg-config finds is this machine's otherwise.
set(ENV{PKG_CONFIG_LIBDIR} /usr/lib/aarch64-linux-gnu/pkgconfig:/usr/share/pkgconfig)
# Debian's libyaml-cpp-dev is for one architecture at a time: that of the machine stays.
set(yaml-cpp_DIR ${CMAKE_CURRENT_LIST_DIR})
