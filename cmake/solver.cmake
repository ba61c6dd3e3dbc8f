# SPDX-License-Identifier: MIT
# The sparse direct solvers behind linear/sparse_factor.h. Eigen's is always there; CHOLMOD's (supernodal module: GPL) when chosen.
if(NOT ORBITUTTE_SOLVER MATCHES "^(cholmod|eigen)$")
  message(FATAL_ERROR "ORBITUTTE_SOLVER is '${ORBITUTTE_SOLVER}': choose cholmod or eigen")
endif()
# Only these are compiled again where the solver changes.
set(depends_on_solver src/orbitutte/linear/cholmod_factor.cpp src/orbitutte/linear/sparse_factor.cpp)
set_source_files_properties(${depends_on_solver} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
if(ORBITUTTE_SOLVER STREQUAL "cholmod")
  find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
  orbitutte_import_library(CHOLMOD REQUIRED)
  target_link_libraries(orbitutte PRIVATE orbitutte::CHOLMOD)
  set_source_files_properties(${depends_on_solver} PROPERTIES
    COMPILE_DEFINITIONS ORBITUTTE_HAS_CHOLMOD INCLUDE_DIRECTORIES ${CHOLMOD_INCLUDE_DIR})
endif()
