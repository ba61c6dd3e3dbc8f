# SPDX-License-Identifier: MIT
# The man page and the shells' completions, written by a program that shares the command line's definition.
option(ORBITUTTE_BUILD_REFERENCE "Write the man page and the shells' completions" ON)
if(NOT ORBITUTTE_BUILD_REFERENCE)
  return()
endif()
file(GLOB ORBITUTTE_REFERENCE_SOURCES CONFIGURE_DEPENDS apps/reference/*.cpp)
add_executable(orbitutte_reference ${ORBITUTTE_REFERENCE_SOURCES})
target_link_libraries(orbitutte_reference PRIVATE orbitutte_commands)

set(ORBITUTTE_REFERENCE_DIR ${PROJECT_BINARY_DIR}/reference)
set(ORBITUTTE_REFERENCE_PAGE ${PROJECT_SOURCE_DIR}/apps/reference/orbitutte.1.in)
set(ORBITUTTE_MAN_PAGE ${ORBITUTTE_REFERENCE_DIR}/orbitutte.1)
file(MAKE_DIRECTORY ${ORBITUTTE_REFERENCE_DIR})
set(outputs ${ORBITUTTE_MAN_PAGE} ${ORBITUTTE_REFERENCE_DIR}/orbitutte.bash ${ORBITUTTE_REFERENCE_DIR}/_orbitutte
            ${ORBITUTTE_REFERENCE_DIR}/orbitutte.fish)
add_custom_command(OUTPUT ${outputs} COMMAND orbitutte_reference ${ORBITUTTE_REFERENCE_PAGE} ${ORBITUTTE_REFERENCE_DIR}
                   DEPENDS orbitutte_reference ${ORBITUTTE_REFERENCE_PAGE} VERBATIM)
find_program(GZIP_EXECUTABLE gzip)
if(GZIP_EXECUTABLE)
  add_custom_command(OUTPUT ${ORBITUTTE_MAN_PAGE}.gz COMMAND ${GZIP_EXECUTABLE} -9nkf ${ORBITUTTE_MAN_PAGE}
                     DEPENDS ${ORBITUTTE_MAN_PAGE} VERBATIM)
  string(APPEND ORBITUTTE_MAN_PAGE .gz)
  list(APPEND outputs ${ORBITUTTE_MAN_PAGE})
endif()
add_custom_target(orbitutte_documents ALL DEPENDS ${outputs})
