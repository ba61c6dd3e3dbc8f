// SPDX-License-Identifier: MIT
// Which program wrote a report or a page.
#pragma once

namespace orbitutte {

struct Program {
  const char* version;
  const char* commit;
};

/// This one. A function, so that after a commit one small file is compiled again.
Program this_program();

}  // namespace orbitutte
