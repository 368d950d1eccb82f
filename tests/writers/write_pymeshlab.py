"""pymeshlab: PLY, and XYZ with normals that nobody gave."""
import numpy as np
import pymeshlab

from family import run_family


def save(cloud, files):
    meshes = pymeshlab.MeshSet()
    colors = np.column_stack([cloud.rgb, np.ones(len(cloud.rgb))])
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=cloud.xyz, v_color_matrix=colors))
    meshes.save_current_mesh(files.path("save_current_mesh.ply"))
    meshes.save_current_mesh(files.path("save_current_mesh ascii.ply"), binary=False)
    meshes.save_current_mesh(files.path("save_current_mesh.xyz", columns="x y z - - -", says="normal|no color"))


if __name__ == "__main__":
    run_family([save])
