# SPDX-License-Identifier: MIT
# Debian packages by `cpack` in the build folder: orbitutte, the command; liborbitutte-dev, which is for programs that use it; and
# python3-orbitutte, where the module was built for the system's Python.
# Such packages are passed on, so the preset `package` leaves out what may not be (docs/licences.md), and installs into /usr.
set(ORBITUTTE_PACKAGE_CONTACT "The orbitutte authors <orbitutte@orbitutte.invalid>" CACHE STRING "Maintainer of the packages that cpack makes")

# What copyright says of the binary; `orbitutte --version` says the same.
set(ORBITUTTE_BINARY_LICENCE " MIT, with libraries under permissive licences and the LGPL.")
if(TARGET orbitutte::CHOLMOD)
  set(ORBITUTTE_BINARY_LICENCE
" GPL-3.0-or-later. Its sources are under the MIT licence, but it is linked with CHOLMOD, whose
 supernodal module is under the GPL, version 2 or later, and with libraries under the Apache
 licence 2.0 (METIS, oneTBB, OpenSSL, Embree), which only version 3 of the GPL allows. On Debian
 systems, the full text of the GPL is in /usr/share/common-licenses/GPL-3.")
endif()
if(TARGET orbitutte::MUMPS)
  string(APPEND ORBITUTTE_BINARY_LICENCE "\n It is also linked with MUMPS, which is under CeCILL-C.")
endif()
if(TARGET orbitutte::MUMPS AND TARGET orbitutte::CHOLMOD)
  string(APPEND ORBITUTTE_BINARY_LICENCE " Whether the GPL allows that\n is doubtful: this binary is not to be passed on.")
endif()
configure_file(packaging/copyright ${ORBITUTTE_GENERATED_DIR}/copyright @ONLY)
install(FILES ${ORBITUTTE_GENERATED_DIR}/copyright DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/orbitutte COMPONENT runtime)

if(NOT PROJECT_IS_TOP_LEVEL)
  return()  # packages are then the other project's
endif()
find_program(DPKG_SHLIBDEPS_EXECUTABLE dpkg-shlibdeps)
find_program(FILE_EXECUTABLE file)
if(NOT DPKG_SHLIBDEPS_EXECUTABLE OR NOT FILE_EXECUTABLE OR NOT GZIP_EXECUTABLE OR BUILD_SHARED_LIBS OR NOT ORBITUTTE_BUILD_REFERENCE)
  message(STATUS "No Debian packages: they need dpkg-dev, file, gzip, a static library (BUILD_SHARED_LIBS=OFF) and ORBITUTTE_BUILD_REFERENCE")
  return()
endif()
set(ORBITUTTE_MAKES_DEB ON)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME orbitutte)
set(CPACK_PACKAGE_CONTACT "${ORBITUTTE_PACKAGE_CONTACT}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(description
"Computes seamless, nearly conformal bijections from meshes of spheres, disks
and projective planes onto spherical orbifolds, with a certificate for each.")
set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME orbitutte)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION math)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS fonts-dejavu-core)
set(CPACK_COMPONENT_COMMAND_DESCRIPTION "${description}
This package has the command orbitutte.")

# What a program that is linked with the static library is linked with, too.
set(libraries libeigen3-dev libfmt-dev libssl-dev libtbb-dev libexpat1-dev zlib1g-dev libpng-dev libturbojpeg0-dev libmetis-dev libsuitesparse-dev libmeshoptimizer-dev
              "libopenblas-dev | liblapack-dev | liblapack.so")
if(ORBITUTTE_RENDER)
  list(APPEND libraries libembree-dev libcairo2-dev "pkgconf | pkg-config")
endif()
if(TARGET orbitutte::MUMPS)
  list(APPEND libraries libmumps-seq-dev)
endif()
list(JOIN libraries ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liborbitutte-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "${description}
This package has the headers, the static library, and what find_package()
of CMake and pkg-config need to find them.")

# The system's Python has one folder for packages, whatever the prefix of `cmake --install` asks for.
get_property(python GLOBAL PROPERTY ORBITUTTE_PYTHON_EXECUTABLE)
set(python_components "")
if(python MATCHES "^/usr/bin/python3")
  get_property(version GLOBAL PROPERTY ORBITUTTE_PYTHON_VERSION)
  get_property(sources GLOBAL PROPERTY ORBITUTTE_PYTHON_SOURCES)
  set(folder lib/python3/dist-packages/orbitutte)
  install(TARGETS orbitutte_python LIBRARY DESTINATION ${folder} COMPONENT debian_python EXCLUDE_FROM_ALL)
  install(FILES ${sources} DESTINATION ${folder} COMPONENT debian_python EXCLUDE_FROM_ALL)
  install(FILES ${ORBITUTTE_GENERATED_DIR}/changelog.gz ${ORBITUTTE_GENERATED_DIR}/copyright
          DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/python3-orbitutte COMPONENT debian_python EXCLUDE_FROM_ALL)
  string(REPLACE "." ";" parts ${version})
  list(GET parts 0 major)
  list(GET parts 1 minor)
  math(EXPR next "${minor} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-orbitutte)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= ${version}~), python3 (<< ${major}.${next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-scipy)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/packaging/python3-orbitutte/postinst
                                                ${PROJECT_SOURCE_DIR}/packaging/python3-orbitutte/prerm)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "${description}
This package has the Python module orbitutte.")
  set(python_components debian_python)
endif()

# What every Debian package brings; not part of `cmake --install`.
configure_file(packaging/changelog ${ORBITUTTE_GENERATED_DIR}/changelog @ONLY)
execute_process(COMMAND ${GZIP_EXECUTABLE} -9nkf ${ORBITUTTE_GENERATED_DIR}/changelog COMMAND_ERROR_IS_FATAL ANY)
install(FILES ${ORBITUTTE_GENERATED_DIR}/changelog.gz DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/orbitutte
        COMPONENT debian_runtime EXCLUDE_FROM_ALL)
install(FILES ${ORBITUTTE_GENERATED_DIR}/changelog.gz ${ORBITUTTE_GENERATED_DIR}/copyright
        DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/liborbitutte-dev COMPONENT debian_development EXCLUDE_FROM_ALL)
set(CPACK_COMPONENTS_ALL runtime debian_runtime development debian_development ${python_components})
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
include(CPack)
cpack_add_component_group(command)
cpack_add_component_group(development)
cpack_add_component(runtime GROUP command)
cpack_add_component(debian_runtime GROUP command)
cpack_add_component(development GROUP development)
cpack_add_component(debian_development GROUP development)
if(python_components)
  cpack_add_component_group(python)
  cpack_add_component(debian_python GROUP python)
endif()
