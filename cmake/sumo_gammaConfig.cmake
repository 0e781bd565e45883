# find_package(sumo_gamma) gives sumo_gamma::sumo_gamma
include(${CMAKE_CURRENT_LIST_DIR}/sumo_gammaTargets.cmake)
