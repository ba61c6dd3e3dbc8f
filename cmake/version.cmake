# SPDX-License-Identifier: MIT
# Run at build time: writes OUTPUT from INPUT with the version and the commit of the sources, when it changed.
execute_process(COMMAND git -C "${SOURCE_DIR}" describe --always --dirty --abbrev=12 OUTPUT_VARIABLE ORBITUTTE_COMMIT
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT ORBITUTTE_COMMIT)
  set(ORBITUTTE_COMMIT "unknown")
endif()
configure_file("${INPUT}" "${OUTPUT}" @ONLY)
