# glocal_add_plugin(NAME files…): builds NAME.so, a plugin of glocal. It exports nothing but its entry function, and every symbol it uses
# must be there when it is linked.
# Clang's sanitizers are in the program that loads it.
if(NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  set(GLOCAL_NO_UNDEFINED -Wl,--no-undefined)
endif()
set(GLOCAL_PLUGIN_EXPORTS ${CMAKE_CURRENT_LIST_DIR}/plugin_exports.map)

function(glocal_add_plugin name)
  add_library(${name} MODULE ${ARGN})
  target_compile_features(${name} PRIVATE cxx_std_20)
  # Results must not depend on how the compiler fuses floating-point operations.
  target_compile_options(${name} PRIVATE -ffp-contract=off)
  target_link_libraries(${name} PRIVATE glocal::glocal)
  target_link_options(${name} PRIVATE ${GLOCAL_NO_UNDEFINED} -Wl,--version-script=${GLOCAL_PLUGIN_EXPORTS})
  set_target_properties(${name} PROPERTIES PREFIX "" SUFFIX ".so" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LINK_DEPENDS ${GLOCAL_PLUGIN_EXPORTS})
endfunction()
