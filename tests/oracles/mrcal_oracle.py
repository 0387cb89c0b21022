#!/usr/bin/python3
"""Calibrates with mrcal from the same detections as ours, and prints what it finds as JSON.

usage: mrcal_oracle.py SCENE.json CORNERS.vnl

CORNERS.vnl is mrcal's table of corners, `# filename x y weight`, a whole grid for each picture, row by row; a
weight of "-" leaves a point out. A file's name is frameN-camN.png. SCENE.json has the cameras' sizes, the focal
lengths to start from, the board, the lens model, and points to ask about (in the frame of frame 0's board, as we
have it: rows towards -y; mrcal's rows run towards +y).

Regularisation, outlier rejection and the board's warp are off.
"""
import json
import sys

try:
    import mrcal
    import numpy as np
except ImportError as error:
    print(error, file=sys.stderr)
    sys.exit(77)  # absent

MM = 1e-3


def read_corners(path, columns, rows):
    """By (frame, camera): an array (rows, columns, 3) of x, y, weight."""
    grids = {}
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("#") or not line.strip():
                continue
            name, x, y, weight = line.split()
            frame, camera = name.removesuffix(".png").removeprefix("frame").split("-cam")
            point = (0.0, 0.0, -1.0) if weight == "-" else (float(x), float(y), float(weight))
            grids.setdefault((int(frame), int(camera)), []).append(point)
    return {key: np.array(grid).reshape(rows, columns, 3) for key, grid in sorted(grids.items())}


def rt_of(pose):
    return mrcal.rt_from_Rt(np.vstack((np.array(pose["rotation"]), MM * np.array(pose["translation_mm"]))))


def given_start(start, frames):
    """Poses and focal lengths from the scene; mrcal's own start fails on half-hidden boards seen aslant."""
    half_turn = np.array((np.pi, 0.0, 0.0, 0.0, 0.0, 0.0))
    intrinsics = np.array(start["intrinsics"])
    extrinsics = np.array([rt_of(pose) for pose in start["cam_from_cam0"][1:]])
    poses = np.array([mrcal.compose_rt(rt_of(start["cam0_from_board"][str(f)]), half_turn) for f in frames])
    return intrinsics, extrinsics, poses


def seed(scene, grids, frames):
    """Where to start: the scene's start, or mrcal's own, as mrcal-calibrate-cameras has it; without lenses."""
    sizes = np.array([[c["width"], c["height"]] for c in scene["cameras"]], dtype=np.int32)
    indices = np.array([(frames.index(f), c) for f, c in grids], dtype=np.int32)
    observations = np.array(list(grids.values()))
    if "start" in scene:
        intrinsics, extrinsics, poses = given_start(scene["start"], frames)
    else:
        intrinsics, extrinsics, poses = mrcal.seed_stereographic(
            imagersizes=sizes,
            focal_estimate=[c["focal_px"] for c in scene["cameras"]],
            indices_frame_camera=indices,
            observations=observations,
            object_spacing=scene["square_mm"] * MM,
        )
    count = mrcal.lensmodel_num_params(scene["lensmodel"])
    full = np.zeros((len(intrinsics), count))
    full[:, :4] = intrinsics
    return {
        "intrinsics": full,
        "extrinsics_rt_fromref": extrinsics,
        "frames_rt_toref": poses,
        "points": None,
        "observations_board": observations,
        "indices_frame_camintrinsics_camextrinsics": np.column_stack(
            (indices, indices[:, 1] - 1)
        ).astype(np.int32),
        "observations_point": None,
        "indices_point_camintrinsics_camextrinsics": None,
        "lensmodel": scene["lensmodel"],
        "imagersizes": sizes,
        "calobject_warp": None,
        "do_optimize_calobject_warp": False,
        "do_optimize_frames": True,
        "do_optimize_extrinsics": True,
        "calibration_object_spacing": scene["square_mm"] * MM,
        "do_apply_outlier_rejection": False,
        "do_apply_regularization": False,
        "verbose": False,
    }


def optimize(inputs):
    """Poses first, then focal lengths, then all; until nothing changes."""
    for core, distortion in ((False, False), (True, False), (True, True)):
        inputs["do_optimize_intrinsics_core"] = core
        inputs["do_optimize_intrinsics_distortions"] = distortion
        mrcal.optimize(**inputs)
    last = np.inf
    for _ in range(20):
        now = mrcal.optimize(**inputs)["rms_reproj_error__pixels"]
        if last - now < 1e-12:
            break
        last = now


def board_point(scene_point_mm):
    """mrcal's frame of the board is ours after half a turn about x."""
    x, y, z = scene_point_mm
    return MM * np.array((x, -y, -z))


def gradient_of_first_frame(inputs, camera, point, state_count):
    """d pixel / d state of a point that stands still in frame 0's board."""
    gradient = np.zeros((2, state_count))
    in_ref, by_frame, _ = mrcal.transform_point_rt(inputs["frames_rt_toref"][0], point, get_gradients=True)
    in_cam, by_pose, by_ref = in_ref, None, np.eye(3)
    if camera > 0:
        in_cam, by_pose, by_ref = mrcal.transform_point_rt(
            inputs["extrinsics_rt_fromref"][camera - 1], in_ref, get_gradients=True
        )
    _, by_cam, by_lens = mrcal.project(
        in_cam, inputs["lensmodel"], inputs["intrinsics"][camera], get_gradients=True
    )
    at = mrcal.state_index_intrinsics(camera, **inputs)
    gradient[:, at : at + by_lens.shape[-1]] = by_lens
    if camera > 0:
        at = mrcal.state_index_extrinsics(camera - 1, **inputs)
        gradient[:, at : at + 6] = by_cam @ by_pose
    at = mrcal.state_index_frames(0, **inputs)
    gradient[:, at : at + 6] = by_cam @ by_ref @ by_frame
    return in_cam, gradient


def inverse_normal_matrix(inputs, prior_px):
    """(J^T J + P)^-1 in mrcal's scaled state, and the step that P makes from mrcal's optimum.

    P = prior_px^2 for each distortion coefficient: it is known to be 0 +- 1, as in our fit. mrcal can't have that.
    """
    packed, _, jacobian, _ = mrcal.optimizer_callback(**inputs)
    dense = jacobian.toarray()
    knowledge = np.zeros(dense.shape[1])
    count = inputs["intrinsics"].shape[1]
    for camera in range(len(inputs["intrinsics"])):
        at = mrcal.state_index_intrinsics(camera, **inputs)
        knowledge[at + 4 : at + count] = prior_px
    # A state is the packed one times its scale, so a gradient by the state, "unpacked", is one by the packed state.
    scaled = knowledge.copy()
    mrcal.unpack_state(scaled, **inputs)
    inverse = np.linalg.inv(dense.T @ dense + np.diag(scaled**2))
    step = -inverse @ (scaled**2 * packed)
    mrcal.unpack_state(step, **inputs)
    return inverse, step


def covariance(inverse, gradient, inputs, noise_px):
    scaled = gradient.copy()
    mrcal.unpack_state(scaled, **inputs)
    return noise_px**2 * scaled @ inverse @ scaled.T


def sigma_of_state(inverse, inputs, at, count, noise_px):
    gradient = np.zeros((count, inverse.shape[0]))
    gradient[np.arange(count), at + np.arange(count)] = 1.0
    return np.sqrt(np.diag(covariance(inverse, gradient, inputs, noise_px)))


def camera_result(scene, inputs, camera, noise_px, prior_px):
    inverse, step = inverse_normal_matrix(inputs, prior_px)
    model = mrcal.cameramodel(optimization_inputs=inputs, icam_intrinsics=camera)
    count = inputs["intrinsics"].shape[1]
    at = mrcal.state_index_intrinsics(camera, **inputs)
    intrinsics = inputs["intrinsics"][camera] + step[at : at + count]
    result = {
        "intrinsics": intrinsics.tolist(),
        "intrinsics_sigma": sigma_of_state(inverse, inputs, at, count, noise_px).tolist(),
        "points": [],
    }
    pose = mrcal.identity_rt()
    if camera > 0:
        at = mrcal.state_index_extrinsics(camera - 1, **inputs)
        pose = inputs["extrinsics_rt_fromref"][camera - 1] + step[at : at + 6]
        result["translation_sigma_mm"] = (sigma_of_state(inverse, inputs, at, 6, noise_px)[3:] / MM).tolist()
    result["rotation_cam_from_cam0"] = mrcal.R_from_r(pose[:3]).tolist()
    result["translation_cam_from_cam0_mm"] = (pose[3:] / MM).tolist()
    for point_mm in scene["points_mm"]:
        in_cam, gradient = gradient_of_first_frame(inputs, camera, board_point(point_mm), inverse.shape[0])
        ask = {"what": "worstdirection-stdev", "observed_pixel_uncertainty": noise_px}
        result["points"].append(
            {
                "first_board_px": float(mrcal.worst_direction_stdev(covariance(inverse, gradient, inputs, noise_px))),
                "all_boards_px": float(mrcal.projection_uncertainty(in_cam, model, **ask)),
                "at_infinity_px": float(mrcal.projection_uncertainty(in_cam, model, atinfinity=True, **ask)),
            }
        )
    return result


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        scene = json.load(file)
    grids = read_corners(sys.argv[2], scene["columns"], scene["rows"])
    frames = sorted({frame for frame, _ in grids})
    inputs = seed(scene, grids, frames)
    optimize(inputs)
    residuals = mrcal.optimizer_callback(**inputs)[1]
    weights = inputs["observations_board"][..., 2].ravel()
    used = weights > 0.0
    weighted = residuals[: 2 * weights.size].reshape(-1, 2)[used]
    plain = weighted / weights[used, None]
    states = mrcal.num_states(**inputs)
    # s^2 = sum of squares over degrees of freedom; mrcal itself takes the plain mean.
    scale = np.sqrt(np.sum(weighted**2) / (weighted.size - states))
    noise_px = scene.get("noise_px", scale)
    print(
        json.dumps(
            {
                "points": int(np.count_nonzero(used)),
                "states": states,
                "rms_px": float(np.sqrt(np.mean(np.sum(plain**2, axis=1)))),
                "noise_px": float(scale),
                "mrcal_noise_px": float(
                    np.std(mrcal.residuals_chessboard(inputs, residuals=residuals).ravel())
                ),
                # As mrcal has it, and with what our fit knows of lenses beforehand.
                "cameras": [camera_result(scene, inputs, i, noise_px, 0.0) for i in range(len(scene["cameras"]))],
                "knowing_lenses": [
                    camera_result(scene, inputs, i, noise_px, noise_px) for i in range(len(scene["cameras"]))
                ],
            }
        )
    )


if __name__ == "__main__":
    main()
