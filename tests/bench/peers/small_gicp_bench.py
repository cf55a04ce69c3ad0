# SPDX-License-Identifier: BSD-3-Clause
"""Measures the time of small_gicp's single-thread point-to-plane registration on the clouds of registration_clouds. See
README.md."""
import pathlib
import sys
import time

try:
    import numpy as np
    import small_gicp
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

REPEATS = 5


def main(folder: pathlib.Path) -> None:
    target, tree = small_gicp.preprocess_points(
        np.loadtxt(folder / "map.txt"), downsampling_resolution=0.001, num_neighbors=12, num_threads=1)
    times_ms, errors_m, errors_rad = [], [], []
    for cloud in sorted(folder.glob("sweep_*.txt")):
        points = np.loadtxt(cloud)
        poses = np.loadtxt(cloud.with_suffix(".pose")).reshape(2, 4, 4)
        source, _ = small_gicp.preprocess_points(points, downsampling_resolution=0.001, num_threads=1)
        best = float("inf")
        for _ in range(REPEATS):
            start = time.perf_counter()
            result = small_gicp.align(target, source, tree, init_T_target_source=poses[0], registration_type="PLANE_ICP",
                                      max_correspondence_distance=1.0, num_threads=1, max_iterations=30)
            best = min(best, 1e3 * (time.perf_counter() - start))
        error = np.linalg.inv(poses[1]) @ result.T_target_source
        times_ms.append(best)
        errors_m.append(np.linalg.norm(error[:3, 3]))
        errors_rad.append(np.arccos(np.clip((np.trace(error[:3, :3]) - 1.0) / 2.0, -1.0, 1.0)))
    if not times_ms:
        sys.exit(f"{folder}: no sweeps")
    print(f"small_gicp {len(times_ms)} sweeps: median {np.median(times_ms):.2f} ms, worst {max(times_ms):.2f} ms, "
          f"error median {np.median(errors_m):.4f} m {np.median(errors_rad):.5f} rad, worst {max(errors_m):.4f} m")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
