// SPDX-License-Identifier: MIT
// The panels: what each shows, drawn into a box of a canvas.
#pragma once

#include <memory>
#include <vector>

#include "orbitutte/output/render.h"
#include "orbitutte/output/render/canvas.h"

namespace orbitutte {

/// Draws panels of one subject, and keeps between them what they share.
class PanelPainter {
 public:
  /// Keeps references to both.
  PanelPainter(const RenderSubject& subject, const RenderOptions& options);
  ~PanelPainter();

  /// Any panel but the sheet.
  void draw(Panel panel, Canvas& canvas, const Box& box);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// All panels with captions under a headline.
void draw_sheet(PanelPainter& painter, Canvas& canvas, const RenderSubject& subject);

}  // namespace orbitutte
