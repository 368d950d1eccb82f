#pragma once

#include "bytes/file_start.hpp"
#include "cmap/io/byte_source.hpp"
#include "cmap/io/point_cloud_file.hpp"

namespace cmap {

/// Readers of one format each, from the first byte of the source on. They fill in format, counts and notes of `info`.
PointCloud read_ply(ByteSource& source, FileInfo& info);
PointCloud read_pcd(ByteSource& source, FileInfo& info);
/// Uncompressed LAS 1.0 to 1.5. Lengths become meters, by the file's description of its coordinate system. Throws
/// UnsupportedError for longitude and latitude, and where no point is of the classes asked for.
PointCloud read_las(ByteSource& source, FileInfo& info, const ReadOptions& options = {});
PointCloud read_text(ByteSource& source, FileInfo& info);
/// An array of numbers of shape (N, 3) to (N, 9), (..., 3) or transposed, or of records with named members.
PointCloud read_npy_cloud(ByteSource& source, FileInfo& info);
/// The arrays of points, colors and mask by their names and shapes: VGGT's predictions, VGGT-SLAM's point maps, clouds
/// of other tools. The file is held in memory.
PointCloud read_npz_cloud(ByteSource& source, FileInfo& info);

/// Leica's PTX: scans as grids, each with its scanner's place and a matrix that moves it into the world.
bool is_ptx(const FileStart& start);
PointCloud read_ptx(ByteSource& source, FileInfo& info);

/// COLMAP's points3D.txt and points3D.bin: points with the pictures that saw them.
bool is_colmap_text(const FileStart& start);
PointCloud read_colmap_text(ByteSource& source, FileInfo& info);
bool is_colmap_binary(const FileStart& start);
PointCloud read_colmap_binary(ByteSource& source, FileInfo& info);

/// Scans as float32 without a header: KITTI's x y z intensity, or nuScenes' x y z intensity ring, told apart by values.
PointCloud read_kitti_bin(ByteSource& source, FileInfo& info);

/// OBJ of vertices only; with faces it is a mesh, and refused.
bool is_obj(const FileStart& start);
PointCloud read_obj_points(ByteSource& source, FileInfo& info);

/// OpenSfM's reconstruction.json: the points of its largest reconstruction. The file is held in memory.
bool is_opensfm(const FileStart& start);
PointCloud read_opensfm(ByteSource& source, FileInfo& info);

/// What read_point_cloud() does, on a source that is already open.
PointCloudFile read_point_cloud(ByteSource& source, const ReadOptions& options = {});

}  // namespace cmap
