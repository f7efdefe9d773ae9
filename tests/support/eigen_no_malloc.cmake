# touchline_loc once more, with Eigen's run-time malloc check on: the tests of loc link touchline_loc_checked in its place.
find_package(Eigen3 REQUIRED NO_MODULE)
add_library(touchline_eigen_no_malloc INTERFACE)
target_compile_options(touchline_eigen_no_malloc INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:SHELL:-include ${CMAKE_CURRENT_LIST_DIR}/eigen_no_malloc.h>)
target_link_libraries(touchline_eigen_no_malloc INTERFACE Eigen3::Eigen)

if(TARGET touchline_loc)
  get_target_property(loc_sources touchline_loc SOURCES)
  list(TRANSFORM loc_sources PREPEND ${PROJECT_SOURCE_DIR}/loc/)
  add_library(touchline_loc_checked STATIC ${loc_sources})
  target_link_libraries(touchline_loc_checked
    PUBLIC touchline_vision touchline_core touchline_eigen_no_malloc PRIVATE touchline_core_options)
  target_sources(touchline_loc_checked INTERFACE ${CMAKE_CURRENT_LIST_DIR}/eigen_no_malloc.cpp)
endif()
