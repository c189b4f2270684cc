# The library without its development package: headers are the same for all architectures.
find_library(YAML_CPP_LIBRARY libyaml-cpp.so.0.7 REQUIRED)
add_library(yaml-cpp SHARED IMPORTED)
set_target_properties(yaml-cpp PROPERTIES IMPORTED_LOCATION ${YAML_CPP_LIBRARY})
