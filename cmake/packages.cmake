# Debian packages by CPack, one a component of cmake/install.cmake: tools/package.sh makes and checks them.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sumo-gamma)
set(SUMOGAMMA_MAINTAINER "The sumo-gamma authors <sumo-gamma@users.noreply.github.com>" CACHE STRING
  "Whom the packages name")
set(CPACK_PACKAGE_CONTACT ${SUMOGAMMA_MAINTAINER})
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
set(CPACK_COMPONENTS_ALL program development)
set(own_version "${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME sumo-gamma)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "sumo (>= 1.15), sumo-tools (>= 1.15)")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/triggers)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "mixed urban traffic by the GAMMA motion model for Eclipse SUMO
Cars, buses, lorries, motorcycles, bicycles and pedestrians on any
OpenStreetMap city, driven by GAMMA beside or instead of SUMO's own models.
SUMO inserts, routes, runs the signals and shows it.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libsumo-gamma-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "sumo-gamma (= ${own_version})")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "headers and CMake package of sumo-gamma
For C++ programs whose own loop drives SUMO's traffic by the GAMMA motion
model: observe, step, advance.")

if(TARGET sumo_gamma_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-sumo-gamma)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  math(EXPR next_python "${SUMOGAMMA_PYTHON_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "sumo-gamma (= ${own_version}), python3-numpy, \
python3 (>= 3.${SUMOGAMMA_PYTHON_MINOR}), python3 (<< 3.${next_python})")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "sumo-gamma for Python
Hands the agents of a loop over TraCI to the GAMMA motion model in two lines,
and has the program's commands as functions.")
endif()

# what Debian's policy asks of each package, and the program's man page and completion
find_program(GZIP_PROGRAM gzip REQUIRED)
set(man_page ${PROJECT_BINARY_DIR}/sumo-gamma.1)
add_custom_command(OUTPUT ${man_page}.gz
  COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:sumo-gamma> -DOUTPUT=${man_page} -DVERSION=${PROJECT_VERSION}
          -P ${PROJECT_SOURCE_DIR}/cmake/man_page.cmake
  COMMAND ${GZIP_PROGRAM} -9nf ${man_page}
  DEPENDS sumo-gamma ${PROJECT_SOURCE_DIR}/cmake/man_page.cmake VERBATIM)
add_custom_target(man_page ALL DEPENDS ${man_page}.gz)
install(FILES ${man_page}.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES packaging/sumo-gamma.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  RENAME sumo-gamma COMPONENT program)

configure_file(packaging/changelog.in ${PROJECT_BINARY_DIR}/changelog.Debian)
execute_process(COMMAND ${GZIP_PROGRAM} -9nf ${PROJECT_BINARY_DIR}/changelog.Debian)
foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} upper)
  set(folder ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  install(FILES ${PROJECT_BINARY_DIR}/changelog.Debian.gz packaging/copyright DESTINATION ${folder}
    COMPONENT ${component})
endforeach()
include(CPack)
