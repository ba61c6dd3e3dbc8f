# SPDX-License-Identifier: MIT
# Part of the build and of the installed package: METIS, AMD, TurboJPEG, CHOLMOD and MUMPS come without a CMake package of their own.
# Makes the imported target orbitutte::NAME and caches where the library is in NAME_LIBRARY; no target where it is not installed, or an
# error after REQUIRED. Debian's libmumps-seq-dev brings a library without a version in its name; libmumps-seq-5.x alone does too well.
function(orbitutte_import_library name)
  string(TOLOWER ${name} names)
  if(name STREQUAL "MUMPS")
    set(names dmumps_seq dmumps_seq-5.8 dmumps_seq-5.7 dmumps_seq-5.6 dmumps_seq-5.5 dmumps_seq-5.4)
  endif()
  find_library(${name}_LIBRARY NAMES ${names} ${ARGN})
  if(${name}_LIBRARY AND NOT TARGET orbitutte::${name})
    add_library(orbitutte::${name} UNKNOWN IMPORTED)
    set_target_properties(orbitutte::${name} PROPERTIES IMPORTED_LOCATION "${${name}_LIBRARY}")
  endif()
endfunction()
