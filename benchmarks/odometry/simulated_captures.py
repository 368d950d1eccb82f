"""Captures of the simulator: three sensors on three ways of 500 m, without a picture that anybody needs."""

import subprocess

# A scan has 20 to 35 thousand points, as the sensors' own have at 10 Hz (the spinning one's turn in coarser steps).
SENSORS = {
    "spinning_32": ["lidar.model=spinning_32", "lidar.azimuth_steps=1080"],
    "avia": ["lidar.model=avia"],
    "mid360": ["lidar.model=mid360"],
}

# Around two by two blocks of a town of four by four: no place is seen twice.
TOWN = [
    "scene.kind=town", "scene.blocks_x=4", "scene.blocks_y=4", "route.kind=block",
    "route.min_m=[-77, -61]", "route.max_m=[77, 61]", "route.length_m=500",
]
# Survey lines over fields, trees and farms.
LAND = ["scene.kind=aerial", "route.kind=scene", "route.name=survey", "route.height_m=0", "route.length_m=500"]
DOWN = ["mount.lidar_translation_m=[0.04165, 0.02326, -0.0284]", "mount.lidar_roll_pitch_yaw_deg=[0, 90, 0]"]

WAYS = {
    "handheld": TOWN + [
        "route.height_m=1.5", "path.rest_s=3", "path.ramp_s=1.5", "path.speed_mps=1.5", "path.corner_m=1.5",
        "path.sway_position_m=0.03", "path.sway_roll_deg=2.5", "path.sway_pitch_deg=3", "path.sway_yaw_deg=4",
        "path.sway_frequency_hz=0.7", "mount.lidar_translation_m=[-0.011, -0.02329, 0.04412]"],
    "vehicle": TOWN + [
        "route.height_m=1.8", "path.rest_s=2", "path.ramp_s=4", "path.speed_mps=10", "path.corner_m=12",
        "path.sway_position_m=0.01", "path.sway_roll_deg=0.4", "path.sway_pitch_deg=0.4", "path.sway_yaw_deg=0.2",
        "path.sway_frequency_hz=1.2", "mount.lidar_translation_m=[0.2, 0, 0.3]"],
    "aerial": LAND + DOWN + [
        "path.rest_s=2", "path.ramp_s=4", "path.speed_mps=10", "path.corner_m=8", "path.sway_position_m=0.15",
        "path.sway_roll_deg=1.5", "path.sway_pitch_deg=1.5", "path.sway_yaw_deg=1", "path.sway_frequency_hz=0.3"],
}
# The Mid-360 does not see 80 m far.
ALTITUDE_M = {"spinning_32": 80, "avia": 80, "mid360": 40}

PICTURES = [
    "camera.width_px=64", "camera.height_px=48", "camera.focal_px=40", "camera.rate_hz=0.1", "camera.supersampling=1",
    "predictions.session_length=3", "predictions.session_overlap=1", "predictions.width_px=56",
    "truth.map_points_per_m2=0.1", "stated.lio=false",
]


def make_capture(simulate, folder, sensor, way, seed, more=()):
    """The folder of the capture; made unless it is there."""
    capture = folder / f"{sensor}_{way}_{seed}"
    if capture.exists():
        return capture
    settings = [*SENSORS[sensor], *WAYS[way], *PICTURES, *more]
    if way == "aerial":
        settings.append(f"scene.survey_altitude_m={ALTITUDE_M[sensor]}")
    command = [simulate, "town", "--output", capture, "--seed", seed, "--quiet"]
    for setting in settings:
        command += ["--set", setting]
    subprocess.run([str(part) for part in command], check=True)
    return capture
