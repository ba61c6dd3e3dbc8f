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
  file(GLOB ORBITUTTE_RENDER_SOURCES CONFIGURE_DEPENDS src/orbitutte/output/render/*.cpp)
  target_sources(orbitutte PRIVATE ${ORBITUTTE_RENDER_SOURCES})
  target_link_libraries(orbitutte PRIVATE embree PkgConfig::CAIRO)
endif()
