// SPDX-License-Identifier: MIT
#include "orbitutte/resample/sphere_images.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

using std::numbers::pi;
using PixelCorners = std::array<Vector3, 4>;  // the corners of a pixel

double sphere_triangle_area(const Vector3& a, const Vector3& b, const Vector3& c) {
  return std::abs(Space::sphere().area(a, b, c));
}

// Of a pixel; point(i, j) lies i rows below and j columns to the right of the image's upper left corner.
template <typename Point>
PixelCorners pixel_corners(int row, int column, const Point& point) {
  return {point(row, column), point(row, column + 1), point(row + 1, column + 1), point(row + 1, column)};
}

double sign_or_one(double x) { return x < 0 ? -1 : 1; }

// The point of an octahedral image: x to the right, y up, both -1 .. 1.
Vector3 octahedral_point(double x, double y) {
  const double z = 1 - std::abs(x) - std::abs(y);
  if (z >= 0) return Vector3(x, y, z).normalized();
  return Vector3((1 - std::abs(y)) * sign_or_one(x), (1 - std::abs(x)) * sign_or_one(y), z).normalized();
}

// The faces of a cube: outwards, to the right, down.
struct CubeFace {
  Eigen::Vector3i out, right, down;
};

const std::array<CubeFace, 6>& cube_faces() {
  static const std::array<CubeFace, 6> faces = {{{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                                 {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                                 {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                                 {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                                 {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},
                                                 {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}}};
  return faces;
}

// The point of a face at right = x and down = y, both -1 .. 1.
Vector3 cube_point(int face, double x, double y) {
  const CubeFace& at = cube_faces()[face];
  return (at.out.cast<double>() + x * at.right.cast<double>() + y * at.down.cast<double>()).normalized();
}

// Triangles between the centres of pixels: each place where pixels meet is divided into them.
// neighbour(image, row, column) is the number of a pixel, also of one that lies beyond a side by one.
template <typename Neighbour>
Triangles triangles_between(const Grid& grid, int images, int size, const Neighbour& neighbour) {
  std::set<std::array<int, 4>> on_sides;
  std::vector<std::array<int, 4>> places;
  places.reserve(static_cast<std::size_t>(images) * (size + 1) * (size + 1));
  for (int image = 0; image < images; ++image)
    for (int row = 0; row <= size; ++row)
      for (int column = 0; column <= size; ++column) {
        const std::array<int, 4> around = {
            neighbour({image, row - 1, column - 1}), neighbour({image, row - 1, column}),
            neighbour({image, row, column}), neighbour({image, row, column - 1})};
        const bool inside = row > 0 && row < size && column > 0 && column < size;
        std::array<int, 4> sorted = around;
        std::sort(sorted.begin(), sorted.end());
        std::fill(std::unique(sorted.begin(), sorted.end()), sorted.end(), sorted.front());
        // Places on the sides are seen from several images, or several times; at corners of a cube, two of
        // the four pixels are one.
        if (inside || on_sides.insert(sorted).second) places.push_back(around);
      }
  std::vector<std::array<int, 3>> found;
  found.reserve(2 * places.size());
  const auto add = [&](int a, int b, int c) {
    if (a == b || b == c || c == a) return;
    const Vector3 p = grid.points.row(a), q = grid.points.row(b), r = grid.points.row(c);
    const double orientation = p.dot((q - p).cross(r - p));
    found.push_back(orientation > 0 ? std::array<int, 3>{a, b, c} : std::array<int, 3>{a, c, b});
  };
  for (const auto& [a, b, c, d] : places) {
    add(a, b, c);
    add(a, c, d);
  }
  Triangles triangles(static_cast<Eigen::Index>(found.size()), 3);
  for (std::size_t t = 0; t < found.size(); ++t)
    triangles.row(static_cast<Eigen::Index>(t)) << found[t][0], found[t][1], found[t][2];
  return triangles;
}

// The rest of a division that is not negative.
int wrapped(int i, int count) {
  const int rest = i % count;
  return rest < 0 ? rest + count : rest;
}

}  // namespace

Grid equirectangular_grid(int height, int width) {
  Grid grid;
  grid.kind = GridKind::equirectangular;
  grid.shape = {height, width};
  grid.points.resize(static_cast<Eigen::Index>(height) * width, 3);
  grid.areas.resize(grid.points.rows());
  parallel_for(height, [&](int row) {
    const double latitude = pi * (0.5 - (row + 0.5) / height);
    const double area = 2 * pi / width * (std::cos(pi * row / height) - std::cos(pi * (row + 1) / height));
    for (int column = 0; column < width; ++column) {
      const double longitude = 2 * pi * ((column + 0.5) / width - 0.5);
      const Eigen::Index k = static_cast<Eigen::Index>(row) * width + column;
      grid.points.row(k) << std::cos(latitude) * std::sin(longitude), std::sin(latitude),
          std::cos(latitude) * std::cos(longitude);
      grid.areas[k] = area;
    }
  });
  return grid;
}

Eigen::Vector2d equirectangular_place(const Vector3& point, int height, int width) {
  const double longitude = std::atan2(point.x(), point.z()),
               latitude = std::atan2(point.y(), std::hypot(point.x(), point.z()));
  return {(longitude / (2 * pi) + 0.5) * width - 0.5, (0.5 - latitude / pi) * height - 0.5};
}

ImagePixel equirectangular_pixel(const ImagePixel& pixel, int height, int width) {
  ImagePixel inside = pixel;
  if (pixel.row < 0 || pixel.row >= height) {
    inside.row = pixel.row < 0 ? -1 - pixel.row : 2 * height - 1 - pixel.row;
    inside.column += width / 2;
  }
  inside.column = wrapped(inside.column, width);
  return inside;
}

// Pixels are divided along the diagonals that lie on the equator of the octahedron, where they do.
Grid octahedral_grid(int size) {
  Grid grid;
  grid.kind = GridKind::octahedral;
  grid.shape = {size, size};
  grid.points.resize(static_cast<Eigen::Index>(size) * size, 3);
  grid.areas.resize(grid.points.rows());
  const auto place = [&](double i) { return 2 * i / size - 1; };
  parallel_for(size, [&](int row) {
    for (int column = 0; column < size; ++column) {
      const Eigen::Index k = static_cast<Eigen::Index>(row) * size + column;
      grid.points.row(k) = octahedral_point(place(column + 0.5), -place(row + 0.5)).transpose();
      const PixelCorners cell = pixel_corners(
          row, column, [&](double i, double j) { return octahedral_point(place(j), -place(i)); });
      // In the upper left and the lower right quarter the equator runs from the lower left to the upper
      // right.
      const bool rising = (2 * column < size) == (2 * row < size);
      grid.areas[k] = rising ? sphere_triangle_area(cell[0], cell[1], cell[3]) +
                                   sphere_triangle_area(cell[1], cell[2], cell[3])
                             : sphere_triangle_area(cell[0], cell[1], cell[2]) +
                                   sphere_triangle_area(cell[0], cell[2], cell[3]);
    }
  });
  grid.triangles = triangles_between(grid, 1, size, [&](const ImagePixel& pixel) {
    const ImagePixel inside = octahedral_pixel(pixel, size);
    return inside.row * size + inside.column;
  });
  return grid;
}

ImagePixel octahedral_pixel(const ImagePixel& pixel, int size) {
  ImagePixel inside = pixel;
  if (inside.column < 0 || inside.column >= size) {
    inside.column = inside.column < 0 ? -1 - inside.column : 2 * size - 1 - inside.column;
    inside.row = size - 1 - inside.row;
  }
  if (inside.row < 0 || inside.row >= size) {
    inside.row = inside.row < 0 ? -1 - inside.row : 2 * size - 1 - inside.row;
    inside.column = size - 1 - inside.column;
  }
  return inside;
}

Grid cube_grid(int size) {
  Grid grid;
  grid.kind = GridKind::cube;
  grid.shape = {6, size, size};
  grid.points.resize(6 * static_cast<Eigen::Index>(size) * size, 3);
  grid.areas.resize(grid.points.rows());
  const auto place = [&](double i) { return 2 * i / size - 1; };
  parallel_for(6 * size, [&](int k) {
    const int face = k / size, row = k % size;
    for (int column = 0; column < size; ++column) {
      const Eigen::Index at = static_cast<Eigen::Index>(k) * size + column;
      grid.points.row(at) = cube_point(face, place(column + 0.5), place(row + 0.5)).transpose();
      const PixelCorners cell = pixel_corners(
          row, column, [&](double i, double j) { return cube_point(face, place(j), place(i)); });
      grid.areas[at] =
          sphere_triangle_area(cell[0], cell[1], cell[2]) + sphere_triangle_area(cell[0], cell[2], cell[3]);
    }
  });
  grid.triangles = triangles_between(grid, 6, size, [&](const ImagePixel& pixel) {
    const ImagePixel inside = cube_pixel(pixel, size);
    return (inside.image * size + inside.row) * size + inside.column;
  });
  return grid;
}

// In whole numbers the cube has the half edge `size`, and the centres of pixels are odd numbers. What lies
// beyond an edge is folded over it: from `right` to the inside.
ImagePixel cube_pixel(const ImagePixel& pixel, int size) {
  const CubeFace& from = cube_faces()[pixel.image];
  int out = size, right = 2 * pixel.column + 1 - size, down = 2 * pixel.row + 1 - size;
  const auto fold = [&](int& over, int& under) {
    const int beyond = std::abs(over) - size;
    if (beyond <= 0) return;
    under = under < 0 ? beyond - size : size - beyond;
    over = over < 0 ? -size : size;
  };
  const bool is_over_side = std::abs(right) > size;
  fold(right, out);
  fold(down, is_over_side ? right : out);
  const Eigen::Vector3i place = out * from.out + right * from.right + down * from.down;
  for (int face = 0; face < 6; ++face) {
    const CubeFace& to = cube_faces()[face];
    if (place.dot(to.out) != size) continue;
    return {face, (place.dot(to.down) + size - 1) / 2, (place.dot(to.right) + size - 1) / 2};
  }
  return pixel;  // not reached: one coordinate is `size`
}

}  // namespace orbitutte
