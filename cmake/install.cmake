# What `cmake --install` puts into a prefix, by component (cmake/packages.cmake makes a package of each):
# program: sumo-gamma, the shared library that it has in common with the others, libsumo's module, man page, completion
# development: headers and find_package(sumo_gamma)
# python: `import sumo_gamma`, where pybind11 is there
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# error.cpp is compiled into the shared library itself, so that Error is exported; an object of its own in the base library,
# too, it is not taken from there once more
set_source_files_properties(src/base/error.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
# one shared library of everything, with the symbols of src/sumo_gamma and of the errors that it throws alone: users need
# none of what it is made of
add_library(sumo_gamma SHARED $<TARGET_OBJECTS:sumogamma_sumo_gamma> src/base/error.cpp)
target_link_libraries(sumo_gamma PRIVATE sumogamma_app)
target_link_options(sumo_gamma PRIVATE -Wl,--no-undefined -Wl,--exclude-libs,ALL)
# no promise about the binary interface before 1.0: each minor version has a name of its own
set_target_properties(sumo_gamma PROPERTIES OUTPUT_NAME sumo-gamma VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} LINKER_LANGUAGE CXX)
target_compile_features(sumo_gamma INTERFACE cxx_std_20)
# in the source tree headers are named from src/, once installed from the prefix
target_include_directories(sumo_gamma INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
if(TARGET sumo-gamma-libsumo)
  add_dependencies(sumo_gamma sumo-gamma-libsumo)
endif()

# the public headers: few, with nothing in them but the standard library
set(SUMOGAMMA_PUBLIC_HEADERS src/sumo_gamma/session.h src/sumo_gamma/program.h)

install(TARGETS sumo-gamma RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(TARGETS sumo_gamma EXPORT sumo_gammaTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT program NAMELINK_COMPONENT development)
install(TARGETS sumo-gamma-libsumo LIBRARY DESTINATION lib/sumo-gamma COMPONENT program)
install(FILES ${SUMOGAMMA_PUBLIC_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sumo_gamma COMPONENT development)
# named from there by the other headers
install(FILES src/base/error.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/sumo_gamma/base COMPONENT development)

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/sumo_gamma)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/sumo_gammaConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/sumo_gammaConfig.cmake ${PROJECT_BINARY_DIR}/sumo_gammaConfigVersion.cmake
  DESTINATION ${config_folder} COMPONENT development)
install(EXPORT sumo_gammaTargets NAMESPACE sumo_gamma:: DESTINATION ${config_folder} COMPONENT development)
