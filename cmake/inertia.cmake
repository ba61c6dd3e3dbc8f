# SPDX-License-Identifier: MIT
# The LDL' behind verify/inertia.h. Eigen's is always there; the sequential MUMPS (CeCILL-C) where it is installed. Debian's
# libmumps-seq-dev brings a library without a version in its name; libmumps-seq-5.x alone, with libmumps-headers-dev, does too well.
option(ORBITUTTE_MUMPS "Use MUMPS for theorem 2's inertia where it is installed" ON)
if(ORBITUTTE_MUMPS)
  find_path(MUMPS_INCLUDE_DIR dmumps_c.h)
  find_library(MUMPS_LIBRARY NAMES dmumps_seq dmumps_seq-5.8 dmumps_seq-5.7 dmumps_seq-5.6 dmumps_seq-5.5 dmumps_seq-5.4)
  if(MUMPS_INCLUDE_DIR AND MUMPS_LIBRARY)
    target_include_directories(orbitutte SYSTEM PRIVATE ${MUMPS_INCLUDE_DIR})
    target_link_libraries(orbitutte PRIVATE ${MUMPS_LIBRARY})
    target_compile_definitions(orbitutte PRIVATE ORBITUTTE_HAS_MUMPS)
  else()
    message(STATUS "MUMPS (libmumps-seq-dev) is not installed: theorem 2's inertia comes from Eigen")
  endif()
endif()
