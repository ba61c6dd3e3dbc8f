// SPDX-License-Identifier: MIT
// Regular grids: points at which programs that know no meshes want the values of a surface.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/names.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

enum class GridKind {
  /// The icosahedron, its triangles divided into four again and again: 10 * 4^L + 2 vertices at level L. The
  /// vertices of a level are the first ones of the next.
  icosphere,
  /// The 12 N^2 pixels of HEALPix, in the order of its rings or in the nested one; north is z = 1, longitude
  /// 0 in direction of x.
  healpix,
  healpix_nested,
  /// An image of longitude and latitude. As in the texture chart of that name, the poles are (0, +-1, 0), the
  /// upper one above; the middle of the image is (0, 0, 1), and x is to the right.
  equirectangular,
  /// An image of an unfolded octahedron: as the texture chart of that name, (0, 0, 1) in the middle, x to the
  /// right and y up, (0, 0, -1) at all four corners.
  octahedral,
  /// Six images, +x, -x, +y, -y, +z, -z, each as cube maps of graphics programs have it.
  cube,
  /// The vertices of any triangulated sphere.
  sphere,
  /// An image of the torus that covers a flat orbifold: one cell of the translations of its group. It goes on
  /// beyond each side at the opposite one. Its sides are the two shortest translations, the first one to the
  /// right, the second one up.
  periodic,
  /// An image of a tile of 442, 2222 or *2222 that is a square, a parallelogram or a rectangle: a quarter or
  /// a
  /// half of that cell. It goes on beyond its sides as the group has it.
  tile
};

/// Its names.
template <>
struct NameTable<GridKind> {
  static constexpr NamedValue<GridKind> rows[] = {{GridKind::icosphere, "ico"},
                                                  {GridKind::healpix, "healpix"},
                                                  {GridKind::healpix_nested, "healpix-nested"},
                                                  {GridKind::equirectangular, "equirectangular"},
                                                  {GridKind::octahedral, "octahedral"},
                                                  {GridKind::cube, "cube"},
                                                  {GridKind::sphere, "sphere", false},
                                                  {GridKind::periodic, "periodic"},
                                                  {GridKind::tile, "tile"}};
};

/// A grid that is asked for.
struct GridRequest {
  GridKind kind = GridKind::icosphere;

  /// The level of an icosphere, N of HEALPix, otherwise the height of the image, or of each of the six.
  int size = 0;

  /// Of an image; otherwise 0.
  int width = 0;
};

/// Reads "ico:7", "healpix:64", "healpix-nested:64", "equirectangular:512x256" (width and height; "512" is
/// the same), "octahedral:256", "cube:128", "periodic:256" or "periodic:512x256", "tile:256" or
/// "tile:256x512". Throws ArgumentError naming what is wrong: a kind that does not exist, a size that is out
/// of range (no grid may have more than 10^8 points), widths of equirectangular and sizes of octahedral
/// images that are odd, and nested pixels where the size is no power of two.
GridRequest parse_grid(const std::string& text);

/// How a flat image lies in the plane. In the basis of the lattice, two translations of the group as the
/// first two columns and a point as the third one, the image is the box [0, across] x [0, up].
struct FlatImage {
  Matrix3 lattice = Matrix3::Identity();
  double across = 1, up = 1;

  /// Elements of the group, one for each class of elements that differ by translations: the first one is the
  /// identity.
  std::vector<Isometry> sheets;
};

struct Grid {
  GridKind kind = GridKind::icosphere;

  /// Sphere or plane.
  Space space;

  /// k x 3: unit vectors, or points of the plane z = 1; in the canonical frame of the target.
  Points points;

  /// k: the area of the cell around each point. Their sum is that of what the grid covers: 4 pi on the
  /// sphere.
  Eigen::VectorXd areas;

  /// Of an image its height and width, of a cube 6, height and width: the points are numbered row by row,
  /// from the top left. Otherwise empty.
  std::vector<int> shape;

  /// Triangles between the points, counterclockwise from outside, if values between the points are linear in
  /// these; otherwise none.
  Triangles triangles;

  /// Of flat images.
  FlatImage flat;

  int count() const { return static_cast<int>(points.rows()); }
  bool is_image() const { return !shape.empty(); }
};

/// The grid. Flat images depend on the embedding's group; the others are the same for all. Throws
/// ArgumentError if the grid does not belong to the space of the embedding, if the target has no translations
/// (periodic) or no such tile (tile), and for GridKind::sphere.
Grid make_grid(const GridRequest& request, const Embedding& embedding);

/// A grid of the sphere that depends on nothing else. Throws ArgumentError for flat images and
/// GridKind::sphere.
Grid make_grid(const GridRequest& request);

/// The vertices of a closed surface around the origin, such as FreeSurfer's `fsaverage` spheres, put onto the
/// unit sphere. Throws MeshError if a vertex is at the origin, or if the triangles do not cover the sphere
/// once, up to small folds.
Grid sphere_grid(const Points& V, const Triangles& triangles);

/// The point of an image at a row and a column, which may lie beyond its sides by up to its size: there the
/// image goes on as its surface does: around the sphere, the octahedron, the cube, or by the group. Of a cube
/// `image` is one of the six, otherwise 0. Beyond the corners of a cube, where no image lies, it is that on
/// the side of the column.
struct ImagePixel {
  int image = 0, row = 0, column = 0;
};
int pixel_number(const Grid& grid, const ImagePixel& pixel);

/// The points of an image with a margin of so many rows and columns on every side: for an image of h x w, (h
/// + 2 margin) (w + 2 margin) numbers of points, row by row; of a cube six times that. Throws ArgumentError
/// if the grid is no image, or the margin negative or larger than its height or width.
std::vector<int> padded_points(const Grid& grid, int margin);

/// Its shape.
std::vector<int> padded_shape(const Grid& grid, int margin);

}  // namespace orbitutte
