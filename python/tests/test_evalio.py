# SPDX-License-Identifier: BSD-3-Clause
"""Tests with the released evalio: the pipeline tumble and its recordings in evalio, and evalio's pipelines as methods of the program."""
import os
import pathlib
import subprocess
import sys
import textwrap

import h5py
import numpy as np
import pytest

import tumble

evalio = pytest.importorskip("evalio", reason="PyPI's evalio")
pytest.importorskip("tumble_evalio", reason="python/evalio")

from tumble.evalio.clouds import ORIGIN_NS, Grid  # noqa: E402

pytestmark = pytest.mark.program
ROOT = pathlib.Path(__file__).parents[2]


@pytest.fixture(scope="module")
def stroll(program, tmp_path_factory):
    """A rig that is carried gently through a hall, which every pipeline must follow."""
    return tumble.record("stroll", tmp_path_factory.mktemp("stroll") / "hall.h5", seed=1)


def cut(path, target, sweeps):
    """Returns a recording cut after its first sweeps."""
    recording = tumble.read(path)
    lidar, (imu, *_) = recording.sweeps, recording.imus
    points, samples = int(lidar.sweep_first[sweeps]), int(np.searchsorted(imu.time_ns, lidar.sweep_start_ns[sweeps])) + 1
    short = tumble.Lidar(lidar.sweep_start_ns[:sweeps], lidar.sweep_first[: sweeps + 1], lidar.position[:points], lidar.offset_ns[:points],
                         lidar.sweep_period_ns, lidar.T_BL, lidar.range_m[:points], lidar.intensity[:points], lidar.ring[:points],
                         lidar.name, lidar.device)
    imu.time_ns, imu.gyro, imu.accel, imu.clip_flags = imu.time_ns[:samples], imu.gyro[:samples], imu.accel[:samples], None
    tumble.write(target, tumble.Recording(imus=[imu], lidars=[short], robot=recording.robot, gravity_m_s2=recording.gravity_m_s2))
    return target


def in_evalio(code, **environment):
    """Runs Python code with $EVALIO_CUSTOM set; returns exit status and output."""
    ended = subprocess.run([sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=250,
                           env=os.environ | {"EVALIO_CUSTOM": "tumble.evalio"} | {k: str(v) for k, v in environment.items()})
    return ended.returncode, ended.stdout + ended.stderr


RUN = """
    import numpy as np
    from evalio import datasets, pipelines, types
    import tumble
    sequence = datasets.get_sequence("tumble/{name}")
    imu = sequence.recording().imus[0]
    pipeline = pipelines.get_pipeline("tumble")()
    body = dict(zip([f"own_body_{{end}}_{{axis}}_m" for end in ("low", "high") for axis in "xyz"],
                    [*tumble.processing.RIG_BODY_L[0], *tumble.processing.RIG_BODY_L[1]]))
    arm = dict(zip(["lever_arm_x_m", "lever_arm_y_m", "lever_arm_z_m"], imu.lever_arm_m.tolist()))
    left = pipeline.set_params(body | arm | {{"gyro_range_rad_s": imu.gyro_range_rad_s, "accel_range_m_s2": imu.accel_range_m_s2, "no": 1}})
    assert left == {{"no": 1}}, left
    pipeline.set_imu_params(sequence.imu_params())
    pipeline.set_lidar_params(sequence.lidar_params())
    pipeline.set_imu_T_lidar(sequence.imu_T_lidar())
    pipeline.initialize()
    for each in sequence:
        (pipeline.add_imu if isinstance(each, types.ImuMeasurement) else pipeline.add_lidar)(each)
    poses = pipeline.saved_estimates()
    assert len(poses) > 100
    pipeline.finish()
    poses += pipeline.saved_estimates()
    np.savez("{out}", time_ns=[s.to_nsec() for s, _ in poses], position=[p.trans for _, p in poses], T_IL=sequence.imu_T_lidar().to_mat(),
             quaternion=[[p.rot.qx, p.rot.qy, p.rot.qz, p.rot.qw] for _, p in poses], map=len(pipeline.map()["map"]))
"""


def test_poses_equal_those_of_tumbling_odometry(recordings, tmp_path):
    """Poses through evalio are identical to direct ones, and equal those of the program up to the rounding of the mounting quaternion."""
    short = cut(recordings["hill"], tmp_path / "tumbling.h5", 40)
    status, said = in_evalio(RUN.format(name="tumbling", out=tmp_path / "poses.npz"), TUMBLE_EVALIO_FILES=short)
    assert status == 0, said
    through, recording = np.load(tmp_path / "poses.npz"), tumble.read(short)
    recording.imus[0].clip_flags = None
    own = tumble.tumbling(recording, lidar=tumble.sheets.rs16(), T_IL=through["T_IL"])
    assert len(own.poses) > 300 and np.array_equal(through["time_ns"] - ORIGIN_NS, own.poses.time_ns)
    assert np.array_equal(through["position"], own.poses.position) and np.array_equal(through["quaternion"], own.poses.quaternion)
    assert through["map"] == len(own.map) > 1000
    expected = tumble.read_estimate(tumble.estimate(short, "slam/tumble_lag", tmp_path / "program")).sweep_poses
    assert np.array_equal(expected.time_ns, own.poses.time_ns) and np.abs(expected.position - through["position"]).max() < 1e-6
    other = tumble.tumbling(recording, lidar=tumble.sheets.rs16(), T_IL=through["T_IL"], lag_s=0.1)
    assert not np.array_equal(other.poses.position[:300], through["position"][:300]), "the negative control"


def test_evalio_runs_ours_and_theirs(stroll, tmp_path):
    """Scores `evalio run` on a recording of this project: both pipelines follow a stroll."""
    (tmp_path / "both.yaml").write_text("datasets: [{name: tumble/hall}]\npipelines: [tumble, kiss]\n")
    ended = subprocess.run([pathlib.Path(sys.executable).parent / "evalio", "run", "-c", "both.yaml"], cwd=tmp_path, capture_output=True,
                           text=True, timeout=250, env=os.environ | {"EVALIO_CUSTOM": "tumble.evalio", "TUMBLE_EVALIO_FILES": str(stroll)})
    assert ended.returncode == 0, ended.stdout + ended.stderr
    folder, imu = tmp_path / "evalio_results/both/tumble/hall", tumble.read(stroll).imus[0]
    errors = {}
    for name, levelled in (("tumble", None), ("kiss", imu)):
        text = (folder / f"{name}.csv").read_text()
        assert "status: complete" in text, ended.stdout + ended.stderr
        tumble.write_tum(tmp_path / f"{name}.tum", tumble.evalio.read_poses(folder / f"{name}.csv", levelled))
        errors[name] = tumble.score(tmp_path / f"{name}.tum", stroll, kind="slam")["ate_m"]
    assert errors["tumble"] < 0.1 and errors["kiss"] < 0.5, errors
    wrong = tumble.read_tum(tmp_path / "tumble.tum")
    wrong.position = wrong.position[:, [1, 0, 2]]
    tumble.write_tum(tmp_path / "wrong.tum", wrong)
    assert tumble.score(tmp_path / "wrong.tum", stroll, kind="slam")["ate_m"] > 1.0, "the negative control"
    truth = tumble.evalio.read_poses(folder / "gt.csv")
    recorded = tumble.read(stroll).truth
    assert len(truth) == len(recorded.position) and np.array_equal(truth.time_ns, recorded.time_ns)


def test_a_pipeline_of_evalio_is_a_method(stroll, tmp_path, monkeypatch):
    """Runs evalio's `kiss` as a method of the program, through the adapter in peers/."""
    monkeypatch.setenv("TUMBLE_PEERS", sys.prefix)
    words = ", ".join(f'"{word}"' for word in (ROOT / "peers/run", ROOT / "peers/adapt.py", "evalio_pipeline", "{recording}", "{output}", "kiss"))
    (tmp_path / "kiss.yaml").write_text(f"name: kiss_of_evalio\nkind: slam\nframe: imu\nrobots: [rig]\ncommand: [{words}]\n")
    folder = tumble.estimate(stroll, tmp_path / "kiss.yaml", tmp_path / "kiss")
    assert tumble.score(folder, stroll)["translation_error_end_m"] < 0.5


def test_recordings_as_a_data_set(recordings, tmp_path):
    """The data set contains every sample and every return that is not from the rig itself, to the bit."""
    code = """
        import numpy as np
        from evalio import datasets, types
        import tumble
        from tumble.evalio.clouds import ORIGIN_NS
        sequence = datasets.get_sequence("tumble/hill")
        recording = sequence.recording()
        sweeps = [each for each in sequence.lidar()]
        assert len(sweeps) == len(sequence) == len(recording.sweeps)
        samples = [each for each in sequence.imu()]
        imu = recording.imus[0]
        assert np.array_equal([each.stamp.to_nsec() - ORIGIN_NS for each in samples], imu.time_ns)
        assert np.array_equal([each.gyro for each in samples], imu.gyro) and np.array_equal([each.accel for each in samples], imu.accel)
        own, low, high = recording.sweeps[5], *np.float32(tumble.processing.RIG_BODY_L)
        kept = ~np.all((own.position > low) & (own.position < high), axis=1)
        points = [p for p in sweeps[5].points if (p.x, p.y, p.z) != (0, 0, 0)]
        points.sort(key=lambda p: p.t.to_nsec())
        assert np.array_equal([(p.x, p.y, p.z) for p in points], own.position[kept]) and kept.sum() > 1000
        assert np.array_equal([p.t.to_nsec() for p in points], own.offset_ns[kept]) and np.array_equal([p.row for p in points], own.ring[kept])
        assert len(sweeps[5].points) == sequence.lidar_params().num_rows * sequence.lidar_params().num_columns
        assert np.abs(sequence.imu_T_lidar().to_mat() - recording.T_IL).max() < 1e-12
    """
    status, said = in_evalio(code, TUMBLE_EVALIO_FILES=recordings["hill"])
    assert status == 0, said


def test_a_draw_is_simulated_where_evalio_loads_down(tmp_path):
    command = [pathlib.Path(sys.executable).parent / "evalio", "-D", str(tmp_path), "dl", "tumble/drop_3"]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=250, stdin=subprocess.DEVNULL,
                           env=os.environ | {"EVALIO_CUSTOM": "tumble.evalio", "TUMBLE_EVALIO_SEEDS": "3..3"})
    assert ended.returncode == 0, ended.stdout + ended.stderr
    recording = tumble.read(tmp_path / "tumble/drop_3/recording.h5")
    assert (recording.scenario, recording.seed) == ("drop", 3)


def test_without_a_fixed_sequence_returns_stand_one_after_the_other():
    rng = np.random.default_rng(1)
    ring, offset = rng.integers(0, 4, 200).astype(np.uint16), np.sort(rng.choice(10**8, 200, replace=False)).astype(np.uint32)
    lidar = tumble.Lidar(np.array([0]), np.array([0, 200], np.uint64), np.ones((200, 3), np.float32), offset, 10**8, ring=ring)
    grid = Grid(lidar)
    cells = grid.cells(ring, offset)
    assert cells.shape == (4, np.bincount(ring).max()) and sorted(cells[cells >= 0]) == list(range(200))
    assert all((np.diff(row[row >= 0]) > 0).all() and (ring[row[row >= 0]] == k).all() for k, row in enumerate(cells))


def test_a_fixed_sequence_has_a_column_each():
    ring, column = np.repeat(np.arange(3), 50), np.tile(np.arange(50), 3)
    offset = column * 1000 + ring * 300
    order = np.argsort(offset)
    ring, offset, column = ring[order].astype(np.uint16), offset[order].astype(np.uint32), column[order]
    lidar = tumble.Lidar(np.array([0]), np.array([0, 150], np.uint64), np.ones((150, 3), np.float32), offset, 50_000, ring=ring)
    grid = Grid(lidar)
    assert (grid.rows, grid.columns, grid.sequence_ns) == (3, 50, 1000)
    assert np.array_equal(grid.cells(ring, offset)[ring, column], np.arange(150))
    offset[ring == 1] //= 2  # two returns of ring 1 share a column, and both must be kept
    assert sorted(cell for cell in Grid(lidar).cells(ring, offset).ravel() if cell >= 0) == list(range(150))


def test_more_rings_than_evalio_holds():
    lidar = tumble.Lidar(np.array([0]), np.array([0, 2], np.uint64), np.ones((2, 3), np.float32), np.arange(2, dtype=np.uint32), 10**8,
                         ring=np.array([0, 256], np.uint16))
    with pytest.raises(tumble.TumbleError, match="rings is 257"):
        Grid(lidar)


@pytest.mark.parametrize("name, value, word", [("TUMBLE_EVALIO_SEEDS", "1-8", "FIRST..LAST"), ("TUMBLE_EVALIO_SEEDS", "8..1", "FIRST..LAST"),
                                               ("TUMBLE_EVALIO_FILES", "/a/x.h5:/b/x.h5", "two files"),
                                               ("TUMBLE_EVALIO_FILES", "/a/hill_1.h5", "the names of draws")])
def test_settings_that_are_wrong(name, value, word):
    status, said = in_evalio("import evalio", **{name: value})
    assert status != 0 and word in said and name in said, said


def test_a_file_without_an_imu_does_not_spoil_the_list(recordings, tmp_path):
    """Files that are no recordings, and recordings without a lidar, are reported and skipped. All other files are listed."""
    (tmp_path / "none.h5").write_bytes(b"nothing")
    blind = tmp_path / "blind.h5"
    with h5py.File(recordings["hill"]) as whole, h5py.File(blind, "w") as file:
        whole.copy("sensors", file)
        del file["sensors/lidars"]
    given = os.pathsep.join(map(str, (blind, tmp_path / "none.h5", recordings["hill"])))
    status, said = in_evalio("""
        from tumble.evalio import Recordings
        names = [each.value for each in Recordings]
        assert "hill" in names and "blind" not in names and "none" not in names, names
    """, TUMBLE_EVALIO_FILES=given)
    assert status == 0 and "blind.h5 is skipped: it has no lidars" in said and "none.h5 is skipped" in said, said


def test_a_parameter_beyond_its_bounds():
    from tumble.evalio import Tumble

    pipeline = Tumble()
    pipeline.set_params({"lag_s": 100.0})
    pipeline.set_imu_params(evalio.types.ImuParams(gyro=1e-3, accel=1e-3, gravity=np.array([0, 0, -9.8]), rate=100.0))
    pipeline.set_lidar_params(evalio.types.LidarParams(num_rows=16, num_columns=2000, min_range=0.3, max_range=100.0))
    with pytest.raises(RuntimeError, match="initialize"):
        pipeline.add_lidar(evalio.types.LidarMeasurement(evalio.types.Stamp(sec=1, nsec=0)))
    with pytest.raises(tumble.TumbleError) as caught:
        pipeline.initialize()
    assert (caught.value.field, caught.value.value) == ("lag_s", 100.0)


def test_rejected_data_are_skipped_with_a_warning():
    """Covers a sample with an earlier time, a sample with NaN, and a return before its sweep."""
    from tumble.evalio import Tumble

    pipeline, types = Tumble(), evalio.types
    pipeline.set_imu_params(types.ImuParams(gyro=1e-3, accel=1e-3, gravity=np.array([0, 0, -9.8]), rate=100.0))
    pipeline.set_lidar_params(types.LidarParams(num_rows=1, num_columns=2, min_range=0.3, max_range=100.0))
    pipeline.initialize()
    up = np.array([0.0, 0.0, 9.8])
    early = types.Point(x=1.0, y=2.0, z=0.0, t=types.Duration.from_nsec(-5000))
    with pytest.warns(UserWarning, match="-5000 ns"):
        pipeline.add_lidar(types.LidarMeasurement(types.Stamp(sec=1, nsec=0), [early]))
    with pytest.warns(UserWarning) as said:
        pipeline.add_lidar(types.LidarMeasurement(types.Stamp(sec=1, nsec=500_000_000), [types.Point(x=1.0, y=2.0)]))
        for k, gyro in ((1, 0.0), (2, 0.0), (1, 0.0), (3, np.nan), *((k, 0.0) for k in range(4, 90))):
            pipeline.add_imu(types.ImuMeasurement(types.Stamp(sec=1, nsec=k * 10_000_000), np.full(3, gyro), up))
    texts = [str(warning.message) for warning in said]
    assert any("time_order" in text for text in texts) and any("non_finite" in text for text in texts), texts


def test_sweeps_do_not_wait_for_an_imu_without_end():
    from tumble.evalio import Tumble

    pipeline, types = Tumble(), evalio.types
    pipeline.set_imu_params(types.ImuParams(gyro=1e-3, accel=1e-3, gravity=np.array([0, 0, -9.8]), rate=100.0))
    pipeline.set_lidar_params(types.LidarParams(num_rows=1, num_columns=2, min_range=0.3, max_range=100.0))
    pipeline.initialize()
    sweep = lambda k: types.LidarMeasurement(types.Stamp(sec=k // 10, nsec=k % 10 * 100_000_000), [types.Point(x=1.0, y=2.0)])
    for k in range(10, 110):
        pipeline.add_lidar(sweep(k))
    with pytest.raises(RuntimeError, match=r"100 sweeps wait for IMU samples \(from 1.0.* s to 11.0.* s\); .*: no IMU sample has arrived"):
        pipeline.add_lidar(sweep(110))
    # the message distinguishes an IMU with another clock from a missing IMU
    pipeline.add_imu(types.ImuMeasurement(types.Stamp(sec=0, nsec=500_000_000), np.zeros(3), np.array([0.0, 0.0, 9.8])))
    with pytest.raises(RuntimeError, match="the newest IMU sample is at 0.5"):
        pipeline.add_lidar(sweep(110))
    # samples that cover the sweeps make room for new ones
    for k in range(100, 1200):
        pipeline.add_imu(types.ImuMeasurement(types.Stamp(sec=k // 100, nsec=k % 100 * 10_000_000), np.zeros(3), np.array([0.0, 0.0, 9.8])))
    pipeline.add_lidar(sweep(120))


def test_a_different_abi_or_a_missing_package_is_reported(monkeypatch):
    from tumble.evalio.needed import needed_bindings, needed_evalio

    assert needed_bindings().Feed
    monkeypatch.setattr(evalio, "_abi_tag", lambda: "v99_other")
    with pytest.raises(tumble.TumbleError, match="v99_other") as caught:
        needed_bindings()
    assert caught.value.trouble == "evalio"
    monkeypatch.setitem(sys.modules, "tumble_evalio", None)
    with pytest.raises(tumble.TumbleError, match="pip install"):
        needed_bindings()
    monkeypatch.setitem(sys.modules, "evalio", None)
    with pytest.raises(tumble.TumbleError, match="pip install 'evalio"):
        needed_evalio()
