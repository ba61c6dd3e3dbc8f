# SPDX-License-Identifier: MIT
# The LDL' behind verify/inertia.h. Eigen's is always there; the sequential MUMPS (CeCILL-C) where it is installed
# (on Debian: libmumps-headers-dev and libmumps-seq-5.x, or libmumps-seq-dev, which brings them).
option(ORBITUTTE_MUMPS "Use MUMPS for theorem 2's inertia where it is installed" ON)
if(ORBITUTTE_MUMPS)
  find_path(MUMPS_INCLUDE_DIR dmumps_c.h)
  if(MUMPS_INCLUDE_DIR)
    orbitutte_import_library(MUMPS)
  endif()
  if(TARGET orbitutte::MUMPS)
    target_include_directories(orbitutte SYSTEM PRIVATE ${MUMPS_INCLUDE_DIR})
    target_link_libraries(orbitutte PRIVATE orbitutte::MUMPS)
    target_compile_definitions(orbitutte PRIVATE ORBITUTTE_HAS_MUMPS)
  else()
    message(STATUS "MUMPS (libmumps-seq-dev) is not installed: theorem 2's inertia comes from Eigen")
  endif()
endif()
