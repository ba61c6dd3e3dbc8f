# SPDX-License-Identifier: MIT
# The page's template, style and script, compiled in. The script is bundled from viewer/src by esbuild, where ./setup has put it and
# Node.js is there; without, pages have no interactive view and say so.
set(ORBITUTTE_VIEWER_DIR ${PROJECT_SOURCE_DIR}/viewer)
set(ORBITUTTE_MODULES ${ORBITUTTE_VIEWER_DIR}/node_modules)
option(ORBITUTTE_VIEWER "Bundle the page's interactive view where Node.js and viewer/node_modules are there" ON)
find_program(NODE_EXECUTABLE NAMES node nodejs)

# Generates the source that defines NAME with the text of the files, and adds it to the library.
function(orbitutte_embed_text name)
  set(output ${PROJECT_BINARY_DIR}/generated/${name}.cpp)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} "-DNAME=${name}" "-DINPUTS=${ARGN}" "-DOUTPUT=${output}" -P ${PROJECT_SOURCE_DIR}/cmake/embed_text.cmake
    DEPENDS ${ARGN} ${PROJECT_SOURCE_DIR}/cmake/embed_text.cmake VERBATIM)
  target_sources(orbitutte PRIVATE ${output})
  set_source_files_properties(${output} PROPERTIES SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON
                              COMPILE_OPTIONS $<$<CXX_COMPILER_ID:Clang>:-Wno-overlength-strings>)
endfunction()

set(ORBITUTTE_BUNDLE "")
set(ORBITUTTE_BUNDLE_LICENCES "")
if(ORBITUTTE_VIEWER AND NODE_EXECUTABLE AND EXISTS ${ORBITUTTE_MODULES}/esbuild/bin/esbuild AND EXISTS ${ORBITUTTE_MODULES}/three/LICENSE)
  set(ORBITUTTE_BUNDLE ${PROJECT_BINARY_DIR}/generated/viewer.js)
  set(ORBITUTTE_BUNDLE_LICENCES ${ORBITUTTE_MODULES}/three/LICENSE ${ORBITUTTE_MODULES}/three-mesh-bvh/LICENSE)
  file(GLOB ORBITUTTE_VIEWER_SOURCES CONFIGURE_DEPENDS ${ORBITUTTE_VIEWER_DIR}/src/*.js)
  add_custom_command(OUTPUT ${ORBITUTTE_BUNDLE}
    COMMAND ${NODE_EXECUTABLE} ${ORBITUTTE_MODULES}/esbuild/bin/esbuild ${ORBITUTTE_VIEWER_DIR}/src/main.js --bundle --minify
            --format=iife --target=es2020 --charset=utf8 --legal-comments=inline --log-level=warning --outfile=${ORBITUTTE_BUNDLE}
    DEPENDS ${ORBITUTTE_VIEWER_SOURCES} ${ORBITUTTE_VIEWER_DIR}/package-lock.json VERBATIM)
else()
  message(STATUS "No Node.js with viewer/node_modules: pages will have no interactive view (./setup installs both)")
endif()

orbitutte_embed_text(page_template ${ORBITUTTE_VIEWER_DIR}/page.html)
orbitutte_embed_text(page_head ${ORBITUTTE_VIEWER_DIR}/page_head.html)
orbitutte_embed_text(page_foot ${ORBITUTTE_VIEWER_DIR}/page_foot.html)
orbitutte_embed_text(page_view ${ORBITUTTE_VIEWER_DIR}/view.html)
orbitutte_embed_text(map_page_template ${ORBITUTTE_VIEWER_DIR}/map_page.html)
orbitutte_embed_text(map_page_view ${ORBITUTTE_VIEWER_DIR}/map_view.html)
orbitutte_embed_text(page_pictures ${ORBITUTTE_VIEWER_DIR}/pictures.html)
orbitutte_embed_text(page_chart ${ORBITUTTE_VIEWER_DIR}/chart.html)
orbitutte_embed_text(batch_template ${ORBITUTTE_VIEWER_DIR}/batch.html)
orbitutte_embed_text(page_style ${ORBITUTTE_VIEWER_DIR}/style.css)
orbitutte_embed_text(page_script ${ORBITUTTE_BUNDLE})
orbitutte_embed_text(page_licences ${ORBITUTTE_BUNDLE_LICENCES})

find_package(meshoptimizer REQUIRED)
target_link_libraries(orbitutte PRIVATE meshoptimizer::meshoptimizer)
