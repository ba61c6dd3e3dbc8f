// SPDX-License-Identifier: MIT
#include "orbitutte/report/program.h"

#include "orbitutte/version.h"

namespace orbitutte {

Program this_program() { return {version, commit}; }

}  // namespace orbitutte
