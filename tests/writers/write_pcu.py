"""point-cloud-utils: PLY, with colors of 0..1 and of bytes."""
import point_cloud_utils

from family import run_family


def save_mesh(cloud, files):
    lost = {"says": "coars|digit|step|rounded|precis"} if cloud.place == "utm" else {}
    point_cloud_utils.save_mesh_vc(files.path("save_mesh_vc of 0-1.ply", **lost), cloud.xyz, cloud.rgb)
    point_cloud_utils.save_mesh_vc(files.path("save_mesh_vc of bytes.ply", **lost), cloud.xyz, cloud.rgb8)
    point_cloud_utils.save_mesh_v(files.path("save_mesh_v.ply", **lost), cloud.xyz)


if __name__ == "__main__":
    run_family([save_mesh])
