// SPDX-License-Identifier: MIT
// The panels: what each shows, drawn into a box of a canvas.
#pragma once

#include "orbitutte/render/canvas.h"
#include "orbitutte/render/picture_parts.h"

namespace orbitutte {

/// The source mesh with its marked vertices and seams (figures 1 and 3).
void draw_source_panel(Canvas& canvas, const Box& box, PictureParts& parts);

/// The tile and its copies (figures 1, 6 and 7).
void draw_sphere_panel(Canvas& canvas, const Box& box, PictureParts& parts);

/// Area distortion, and angle distortion, in colour, with a scale below (figure 12).
void draw_area_panel(Canvas& canvas, const Box& box, PictureParts& parts);
void draw_angle_panel(Canvas& canvas, const Box& box, PictureParts& parts);

/// A checkerboard on the source mesh (figure 14).
void draw_checkerboard_panel(Canvas& canvas, const Box& box, PictureParts& parts);

/// Any of the panels, plots included, or the sheet.
void draw_panel(Panel panel, Canvas& canvas, const Box& box, PictureParts& parts);

/// All panels with captions under a headline.
void draw_sheet(Canvas& canvas, const Box& box, PictureParts& parts);

/// A box as the size of an image.
PictureSize size_of(const Box& box);

}  // namespace orbitutte
