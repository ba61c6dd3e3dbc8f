# SPDX-License-Identifier: MIT
# The sparse direct solvers behind solve/sparse_factor.h. Eigen's is always there; CHOLMOD's (supernodal module: GPL) when chosen.
if(NOT ORBITUTTE_SOLVER MATCHES "^(cholmod|eigen)$")
  message(FATAL_ERROR "ORBITUTTE_SOLVER is '${ORBITUTTE_SOLVER}': choose cholmod or eigen")
endif()
if(ORBITUTTE_SOLVER STREQUAL "cholmod")
  find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
  orbitutte_import_library(CHOLMOD REQUIRED)
  target_include_directories(orbitutte SYSTEM PRIVATE ${CHOLMOD_INCLUDE_DIR})
  target_link_libraries(orbitutte PRIVATE orbitutte::CHOLMOD)
  target_compile_definitions(orbitutte PRIVATE ORBITUTTE_HAS_CHOLMOD)
endif()
