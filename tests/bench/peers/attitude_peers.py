# SPDX-License-Identifier: BSD-3-Clause
"""Measures the time of published attitude filters per sample in ns, on the motion of attitude_bench. See README.md."""
import importlib
import sys
import time

try:
    import numpy as np
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

RATE_HZ, SAMPLES, REPEATS = 250.0, 5000, 3


def motion() -> tuple[np.ndarray, np.ndarray]:
    """Returns rate [rad/s] and specific force [m/s^2] of a body that moves for 15 s and rests for 5 s."""
    t = np.arange(SAMPLES) / RATE_HZ
    moves = (t < 15.0).astype(float)
    rate = moves[:, None] * np.stack([np.sin(t), 2.0 * np.cos(1.7 * t), 0.5 * np.sin(3.1 * t)], axis=1)
    force = np.stack([moves * np.sin(2.3 * t), moves * np.cos(1.1 * t), np.full(SAMPLES, 9.81)], axis=1)
    return np.ascontiguousarray(rate), np.ascontiguousarray(force)


def peers(rate: np.ndarray, force: np.ndarray):
    """Returns (name, run) of every installed package. Each run is one pass over the samples."""
    def has(module: str) -> bool:
        try:
            importlib.import_module(module)
            return True
        except ImportError as error:
            print(f"{module:12} not there: {error}")
            return False

    if has("vqf"):
        import vqf
        yield "vqf VQF, C++ in one call", lambda: vqf.VQF(1.0 / RATE_HZ).updateBatch(rate, force)
        yield "vqf BasicVQF, C++ in one call", lambda: vqf.BasicVQF(1.0 / RATE_HZ).updateBatch(rate, force)
        yield "vqf PyVQF, Python", lambda: vqf.PyVQF(1.0 / RATE_HZ).updateBatch(rate[:1000], force[:1000])
    if has("ahrs"):
        from ahrs import filters
        for name in ("Madgwick", "Mahony", "Complementary", "EKF"):
            yield f"ahrs {name}, Python", lambda make=getattr(filters, name): make(
                gyr=rate[:1000], acc=force[:1000], frequency=RATE_HZ)
    if has("imufusion"):
        import imufusion

        def fusion() -> None:
            ahrs = imufusion.Ahrs()
            ahrs.set_sample_period(1.0 / RATE_HZ)
            degrees, g = np.degrees(rate), force / 9.80665
            for k in range(SAMPLES):
                ahrs.update_no_magnetometer(degrees[k], g[k])
        yield "imufusion Ahrs, C called from Python", fusion


def main() -> int:
    rate, force = motion()
    timed = 0
    for name, run in peers(rate, force):
        samples = 1000 if name.endswith(", Python") else SAMPLES
        best = float("inf")
        try:
            for _ in range(REPEATS):
                start = time.process_time()
                run()
                best = min(best, time.process_time() - start)
        except Exception as error:  # for example another version of the package; the other packages are still measured
            print(f"{name:40} failed: {error}")
            continue
        timed += 1
        print(f"{name:40} {1e9 * best / samples:10.0f} ns a sample")
    return 0 if timed else 77


if __name__ == "__main__":
    sys.exit(main())
