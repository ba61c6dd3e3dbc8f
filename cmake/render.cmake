# SPDX-License-Identifier: MIT
# Pictures: Embree (3, or 4 where that is installed) casts the rays, Cairo draws text and plots. Without them `orbitutte render` says that it is missing.
option(ORBITUTTE_RENDER "Build 'orbitutte render', which needs Embree and Cairo" ON)
if(ORBITUTTE_RENDER)
  find_package(embree 4 QUIET)
  if(NOT embree_FOUND)
    find_package(embree 3 REQUIRED)
  endif()
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(CAIRO REQUIRED IMPORTED_TARGET cairo cairo-svg cairo-png)
  file(GLOB ORBITUTTE_RENDER_SOURCES CONFIGURE_DEPENDS src/orbitutte/render/*.cpp)
  target_sources(orbitutte PRIVATE ${ORBITUTTE_RENDER_SOURCES})
  # Cairo's headers are for one file only, so that no others are compiled again where pictures are left out. PRIVATE libraries bring
  # theirs to all; a static library is not linked itself, and can leave them to who links it.
  if(BUILD_SHARED_LIBS)
    target_link_libraries(orbitutte PRIVATE embree PkgConfig::CAIRO)
  else()
    target_link_libraries(orbitutte INTERFACE $<LINK_ONLY:embree> $<LINK_ONLY:PkgConfig::CAIRO>)
  endif()
  set_source_files_properties(src/orbitutte/render/canvas.cpp PROPERTIES INCLUDE_DIRECTORIES "${CAIRO_INCLUDE_DIRS}")
else()
  target_sources(orbitutte PRIVATE src/orbitutte/render/missing/comparison.cpp)
endif()
