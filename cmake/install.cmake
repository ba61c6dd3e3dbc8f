# SPDX-License-Identifier: MIT
# What `cmake --install` puts where: the component `runtime` (command, man page, completions, a shared library) and `development`
# (headers, the static library, the packages for CMake and pkg-config). Nothing that is installed names a path of the build.
include(CMakePackageConfigHelpers)
include(CheckCXXSourceCompiles)
include(CheckLinkerFlag)

# The public headers are these and what they include.
set(ORBITUTTE_HEADERS choose distortion_floor embed embed_types errors memory options types
    mesh/intrinsic_triangulation mesh/surface mesh/triangulation
    io/compression io/corner_file io/curve_file io/file io/image_file io/landmark_file io/manifest io/mesh_io io/numpy_array io/png io/texture_file io/vertex_data
    inspect/inspection inspect/mesh_repair inspect/recognition
    samples/sample
    weights/weights
    orbifold/polygon orbifold/signature orbifold/symmetry_group orbifold/target_words
    verify/strain
    cones/cone_wishes cones/extremities cones/marked_cones
    map/alignment map/composed_map map/overlay_certificate map/point_map map/surface_map
    resample/grid resample/resample resample/sparse_table
    report/batch_record report/choices report/comparison report/embedding_file report/inspection_json report/map_report report/report report/verification
    export/carried_files export/cut_triangles export/export export/map_files export/overlay_pieces export/sphere_surface export/stored_map export/texture_bake export/tiling export/value_colours
    page/batch_page page/map_page page/page)
if(ORBITUTTE_RENDER)
  list(APPEND ORBITUTTE_HEADERS render/map_sheet render/render)
endif()
list(TRANSFORM ORBITUTTE_HEADERS PREPEND orbitutte/)
list(TRANSFORM ORBITUTTE_HEADERS APPEND .h)

# Adds to the list all headers that its headers include.
function(orbitutte_close_over_includes headers)
  set(open ${${headers}})
  while(open)
    list(POP_FRONT open header)
    file(STRINGS ${PROJECT_SOURCE_DIR}/src/${header} lines REGEX "^#include \"orbitutte/")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^#include \"(.*)\".*" "\\1" included "${line}")
      if(NOT included IN_LIST ${headers})
        list(APPEND ${headers} ${included})
        list(APPEND open ${included})
      endif()
    endforeach()
  endwhile()
  set(${headers} ${${headers}} PARENT_SCOPE)
endfunction()
orbitutte_close_over_includes(ORBITUTTE_HEADERS)

foreach(header IN LISTS ORBITUTTE_HEADERS)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS src/${header})  # it may include further ones
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES src/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${folder} COMPONENT development)
endforeach()
install(FILES ${ORBITUTTE_GENERATED_DIR}/orbitutte/version.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/orbitutte COMPONENT development)

# Matrices pass between the library and programs, so both have to allocate them alike: types.h refuses programs that are compiled for
# other vector instructions. AddressSanitizer would make Eigen allocate in another way, too, but need not.
set(CMAKE_REQUIRED_LIBRARIES Eigen3::Eigen)
foreach(alignment 16 32 64)
  if(NOT ORBITUTTE_EIGEN_ALIGNMENT)
    check_cxx_source_compiles("#include <Eigen/Core>\nstatic_assert(EIGEN_DEFAULT_ALIGN_BYTES == ${alignment});\nint main() {}"
                              ORBITUTTE_EIGEN_ALIGNS_TO_${alignment})
    if(ORBITUTTE_EIGEN_ALIGNS_TO_${alignment})
      set(ORBITUTTE_EIGEN_ALIGNMENT ${alignment})
    endif()
  endif()
endforeach()
check_cxx_source_compiles("#include <Eigen/Core>\nstatic_assert(EIGEN_MALLOC_ALREADY_ALIGNED);\nint main() {}" ORBITUTTE_EIGEN_USES_MALLOC)
unset(CMAKE_REQUIRED_LIBRARIES)
if(NOT ORBITUTTE_EIGEN_ALIGNMENT)
  message(FATAL_ERROR "Eigen aligns its matrices neither to 16 nor to 32 or 64 bytes with these flags: ${CMAKE_CXX_FLAGS}")
endif()
set(definitions ORBITUTTE_EIGEN_ALIGNMENT=${ORBITUTTE_EIGEN_ALIGNMENT})
if(ORBITUTTE_EIGEN_USES_MALLOC)
  list(APPEND definitions EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()
target_compile_definitions(orbitutte INTERFACE "$<INSTALL_INTERFACE:${definitions}>")
target_compile_features(orbitutte INTERFACE cxx_std_20)

# While the version begins with 0, the next minor version may break programs.
set_target_properties(orbitutte PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(exports ${PROJECT_SOURCE_DIR}/packaging/exports.map)
check_linker_flag(CXX "-Wl,--version-script=${exports}" ORBITUTTE_LINKER_TAKES_EXPORTS)
if(BUILD_SHARED_LIBS AND ORBITUTTE_LINKER_TAKES_EXPORTS)
  target_link_options(orbitutte PRIVATE "-Wl,--version-script=${exports}")
  set_target_properties(orbitutte PROPERTIES LINK_DEPENDS ${exports})
endif()
# The command finds the library from where it is itself, unless that is where the system looks anyway.
if(BUILD_SHARED_LIBS AND NOT CMAKE_INSTALL_FULL_LIBDIR IN_LIST CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES)
  file(RELATIVE_PATH library_from_command ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
  set_target_properties(orbitutte_cli PROPERTIES INSTALL_RPATH "$ORIGIN/${library_from_command}")
endif()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/orbitutte)
install(TARGETS orbitutte_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
install(TARGETS orbitutte EXPORT orbitutteTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT runtime NAMELINK_COMPONENT development)
install(EXPORT orbitutteTargets NAMESPACE orbitutte:: DESTINATION ${package_dir} COMPONENT development)

if(ORBITUTTE_BUILD_REFERENCE)
  set(zsh_folder site-functions)
  if(CMAKE_INSTALL_PREFIX STREQUAL "/usr" AND EXISTS /etc/debian_version)
    set(zsh_folder vendor-completions)  # where Debian's zsh looks for what packages bring
  endif()
  install(FILES ${ORBITUTTE_MAN_PAGE} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime)
  install(FILES ${ORBITUTTE_REFERENCE_DIR}/orbitutte.bash RENAME orbitutte
          DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/bash-completion/completions COMPONENT runtime)
  install(FILES ${ORBITUTTE_REFERENCE_DIR}/_orbitutte DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/zsh/${zsh_folder} COMPONENT runtime)
  install(FILES ${ORBITUTTE_REFERENCE_DIR}/orbitutte.fish DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/fish/vendor_completions.d
          COMPONENT runtime)
endif()

# The package for CMake. Of a static library it also finds what that was linked with.
set(ORBITUTTE_LINKED "")
if(NOT BUILD_SHARED_LIBS)
  set(ORBITUTTE_LINKED library)
  foreach(library METIS AMD TURBOJPEG CHOLMOD MUMPS)
    if(TARGET orbitutte::${library})
      list(APPEND ORBITUTTE_LINKED ${library})
    endif()
  endforeach()
  if(ORBITUTTE_RENDER)
    list(APPEND ORBITUTTE_LINKED render)
  endif()
endif()
configure_package_config_file(packaging/orbitutteConfig.cmake.in ${ORBITUTTE_GENERATED_DIR}/orbitutteConfig.cmake
                              INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${ORBITUTTE_GENERATED_DIR}/orbitutteConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${ORBITUTTE_GENERATED_DIR}/orbitutteConfig.cmake ${ORBITUTTE_GENERATED_DIR}/orbitutteConfigVersion.cmake
              cmake/import_library.cmake DESTINATION ${package_dir} COMPONENT development)

# The package for pkg-config: -lNAME of each library, with -L where its folder is not one of the linker's own.
function(orbitutte_link_flags flags)
  set(result "")
  foreach(library IN LISTS ARGN)
    if(IS_ABSOLUTE "${library}")
      get_filename_component(folder "${library}" DIRECTORY)
      get_filename_component(name "${library}" NAME)
      if(NOT folder IN_LIST CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES)
        string(APPEND result " -L${folder}")
      endif()
      string(REGEX REPLACE "^lib(.*)[.](so|a|dylib)$" "-l\\1" name "${name}")
      string(APPEND result " ${name}")
    else()
      string(APPEND result " ${library}")
    endif()
  endforeach()
  string(STRIP "${result}" result)
  set(${flags} "${result}" PARENT_SCOPE)
endfunction()
list(TRANSFORM definitions PREPEND -D)
list(JOIN definitions " " ORBITUTTE_PC_DEFINITIONS)
set(ORBITUTTE_PC_REQUIRES "fmt libcrypto tbb expat zlib libpng")
# liblapack and libblas by these names may be any of Debian's implementations, while FindLAPACK names one of them.
set(lapack -llapack -lblas)
find_library(ORBITUTTE_LAPACK_LIBRARY lapack)
find_library(ORBITUTTE_BLAS_LIBRARY blas)
mark_as_advanced(ORBITUTTE_LAPACK_LIBRARY ORBITUTTE_BLAS_LIBRARY)
if(NOT ORBITUTTE_LAPACK_LIBRARY OR NOT ORBITUTTE_BLAS_LIBRARY)
  set(lapack ${LAPACK_LIBRARIES})
endif()
set(libraries ${METIS_LIBRARY} ${AMD_LIBRARY} ${TURBOJPEG_LIBRARY} ${lapack} -lmeshoptimizer)
if(TARGET orbitutte::CHOLMOD)
  list(PREPEND libraries ${CHOLMOD_LIBRARY})
endif()
if(TARGET orbitutte::MUMPS)
  list(PREPEND libraries ${MUMPS_LIBRARY})
endif()
if(ORBITUTTE_RENDER)
  string(APPEND ORBITUTTE_PC_REQUIRES " cairo cairo-svg cairo-png")
  list(APPEND libraries -lembree${embree_VERSION_MAJOR})
endif()
orbitutte_link_flags(ORBITUTTE_PC_LIBS ${libraries})
file(RELATIVE_PATH ORBITUTTE_PC_PREFIX ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" ORBITUTTE_PC_PREFIX "${ORBITUTTE_PC_PREFIX}")
file(RELATIVE_PATH ORBITUTTE_PC_LIBDIR ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_LIBDIR})
file(RELATIVE_PATH ORBITUTTE_PC_INCLUDEDIR ${CMAKE_INSTALL_PREFIX} ${CMAKE_INSTALL_FULL_INCLUDEDIR})
configure_file(packaging/orbitutte.pc.in ${ORBITUTTE_GENERATED_DIR}/orbitutte.pc @ONLY)
install(FILES ${ORBITUTTE_GENERATED_DIR}/orbitutte.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
