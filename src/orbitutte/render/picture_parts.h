// SPDX-License-Identifier: MIT
// What the panels of one picture share.
#pragma once

#include <optional>
#include <vector>

#include "orbitutte/render/render.h"
#include "orbitutte/render/source_figure.h"
#include "orbitutte/verify/distortion.h"

namespace orbitutte {

/// How much of a picture's width or height figures fill.
constexpr double figure_fill = 0.9;

/// Each part is made when a panel first asks for it.
class PictureParts {
 public:
  /// Keeps references to both.
  PictureParts(const RenderSubject& subject, const RenderOptions& options)
      : subject_(subject), options_(options) {}

  const RenderSubject& subject() const { return subject_; }
  const Embedding& embedding() const { return subject_.embedding; }
  const RenderOptions& options() const { return options_; }

  const SourceFigure& figure();
  const View& source_view();
  const std::vector<FaceDistortion>& distortion();

  /// The marked vertices on the figure, in the order of the embedding's cones.
  Points marked_positions();

 private:
  const RenderSubject& subject_;
  const RenderOptions& options_;
  std::optional<SourceFigure> figure_;
  std::optional<View> source_view_;
  std::optional<std::vector<FaceDistortion>> distortion_;
};

}  // namespace orbitutte
