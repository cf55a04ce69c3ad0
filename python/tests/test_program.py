# SPDX-License-Identifier: BSD-3-Clause
"""Compares the package with the program: identical results from the same recordings. Also tests calls of the program."""
import dataclasses
import importlib
import sys
import textwrap

import numpy as np
import pytest

import tumble

pytestmark = pytest.mark.program


@pytest.fixture(scope="module")
def estimates(recordings, tmp_path_factory):
    folder = tmp_path_factory.mktemp("estimates")
    kept = {}

    def of(method, recording="hill", **settings):
        key = method, recording
        if key not in kept:
            kept[key] = tumble.read_estimate(
                tumble.estimate(recordings[recording], method, folder / f"{recording}_{method.replace('/', '_')}", settings))
        return kept[key]
    return of


def same(a, b):
    return a.shape == b.shape and len(a) > 100 and np.array_equal(a, b)


def same_covariance(own, expected):
    """Compares the upper triangles, which files contain, because covariances are symmetric only up to rounding."""
    rows, columns = np.triu_indices(3)
    return same(own.covariance[:, rows, columns], expected.covariance[:, rows, columns])


def test_saave(hill, estimates):
    expected = estimates("rate/saave").rates
    own = tumble.Saave(lever_arm_m=hill.imus[0].lever_arm_m, saturation_point_rad_s=10.45).estimate(*hill.imus[0].samples)
    assert same(own.rate, expected.rate) and same_covariance(own, expected) and same(own.time_ns, expected.time_ns)
    assert same(own.source, expected.source) and same(own.clipped_axes, expected.clipped_axes)


def test_rate_stream(hill, estimates):
    expected = estimates("rate/tumble_lag").rates
    own = tumble.rate(hill.imus[0], hill.gravity_m_s2, live=True)
    assert same(own.rate, expected.rate) and same_covariance(own, expected) and same(own.source, expected.source)
    other = tumble.rate(hill.imus[0], hill.gravity_m_s2, live=True, lag_s=0.1)
    assert not same(other.rate, expected.rate), "the negative control"


def test_rate_of_who_carries_what(twirl, estimates):
    """Tests hand-held motion, for which HandHeldSmoother is used."""
    expected = estimates("rate/tumble", "twirl")
    own = tumble.rate(twirl.imus[0], twirl.gravity_m_s2)
    assert expected.health["hand_held_smoother_ran"] == 1.0
    assert same(own.rate, expected.rates.rate) and same_covariance(own, expected.rates) and same(own.source, expected.rates.source)


def test_rate_smoother(hill, estimates):
    expected, imu = estimates("rate/tumble").rates, hill.imus[0]
    own, report = tumble.AngularRateSmoother(
        lever_arm_m=imu.lever_arm_m, gyro_range_rad_s=imu.gyro_range_rad_s, accel_range_m_s2=imu.accel_range_m_s2,
        gyro_noise_density=imu.gyro_noise_rad_s_sqrt_hz, accel_noise_density=imu.accel_noise_m_s2_sqrt_hz).estimate(*imu.samples)
    assert estimates("rate/tumble").health["hand_held_smoother_ran"] == 0.0, "a tumble is not hand-held, so the rates are those of AngularRateSmoother"
    assert same(own.rate, expected.rate) and same_covariance(own, expected)
    assert report.samples == len(imu) and report.clipped == np.count_nonzero(own.clipped_axes) > 0
    assert estimates("rate/tumble").health["lever_arm_x_m"] == report.calibration.lever_arm_m[0]


def test_vqf(hill, estimates):
    assert same(tumble.Vqf().add_imu(*hill.imus[0].samples).quaternion, estimates("attitude/vqf").poses.quaternion)


def test_tumbling(hill, estimates):
    """Compares sweeps, poses, verdicts, covariances and map of a whole tumble."""
    expected = estimates("slam/tumble_lag")
    own = tumble.tumbling(hill)
    assert same(own.poses.position, expected.sweep_poses.position) and same(own.poses.quaternion, expected.sweep_poses.quaternion)
    assert same(own.poses.time_ns, expected.sweep_poses.time_ns)
    assert [int(s.verdict) for s in own.sweeps] == expected.sweeps["verdict"].astype(int).tolist()
    assert [s.iterations for s in own.sweeps] == expected.sweeps["iterations"].astype(int).tolist()
    assert [s.inlier_ratio for s in own.sweeps] == expected.sweeps["inlier_share"].tolist()
    assert len(own.map) > 10000 and own.odometry.second_pass_applied == bool(expected.health["second_pass_applied"])
    assert own.odometry.body_imu_calibration().covariance.shape == (20, 20)


def test_tumbling_sample_by_sample(hill, estimates):
    live = []

    def listen(odometry):
        try:
            live.append(odometry.newest().position)
        except tumble.TumbleError as error:
            assert error.trouble == "empty"

    assert same(tumble.tumbling(hill, on_sample=listen).poses.position, estimates("slam/tumble_lag").sweep_poses.position)
    assert len(live) > 900


def test_rolling_is_the_programs(slip, estimates):
    """RollingOdometry merges the IMUs sample by sample, and the program merges them first: the results agree to 1 % of the path length."""
    expected = estimates("position/tumble_lag", "slip", **{"position/tumble_lag.lag_s": 1.0}).poses
    own = tumble.rolling(slip, lag_s=1.0)
    way = np.linalg.norm(np.diff(expected.position, axis=0), axis=1).sum()
    assert len(own) == len(expected) and way > 1.0
    assert np.linalg.norm(own.position - expected.position, axis=1).max() < 0.01 * way
    truth = slip.truth.position + 0.0
    ended = own.position[-1] - own.position[0] - (truth[-1] - truth[0])
    assert np.linalg.norm(ended[:2]) < 0.02 * way


def test_rolling_odometry_live(slip, estimates, recordings, tmp_path):
    """With one IMU, RollingOdometry and the program's method give identical results."""
    imu = slip.imus[0]
    alone = dataclasses.replace(slip, imus=[imu], truth=None)
    tumble.write(tmp_path / "alone.h5", alone)
    recordings["alone"] = tmp_path / "alone.h5"
    expected = estimates("position/tumble_live", "alone").poses
    own = tumble.rolling(alone)
    assert same(own.position, expected.position) and same(own.quaternion, expected.quaternion)
    other = tumble.rolling(alone, radius_m=1.01 * slip.sphere_radius_m)
    assert not same(other.position, expected.position), "the negative control"


def test_rolling_odometry_states_a_start_in_motion(slip):
    imu = slip.imus[0]
    for first, moving in [(0, False), (int(np.argmax(np.linalg.norm(imu.gyro, axis=1) > 3.0)), True)]:
        odometry = tumble.RollingOdometry(units=[(tumble.ImuDataSheet(rate_hz=1e9 / np.diff(imu.time_ns).mean()), np.eye(4))],
                                          radius_m=slip.sphere_radius_m)
        odometry.add_imu(*(rows[first : first + 50] for rows in imu.samples[:3]))
        assert odometry.started_in_motion == moving


def test_rolling_smoother_over_the_run(slip):
    imu = slip.imus[0]
    smoother = tumble.RollingSmoother(radius_m=slip.sphere_radius_m, lever_arm_m=imu.lever_arm_m, lever_arm_sigma_m=6e-3)
    assert len(smoother.add_imu(*imu.samples)) == 0
    whole = smoother.finish()
    assert len(whole) == len(imu) and np.isfinite(whole.position).all()
    assert set(np.unique(whole.contact_mode)) <= {int(mode) for mode in tumble.ContactMode}


def test_program_reads_what_we_write(hill, recordings, estimates, tmp_path):
    tumble.write(tmp_path / "own.h5", hill)
    again = tumble.read_estimate(tumble.estimate(tmp_path / "own.h5", "rate/tumble_lag", tmp_path / "again"))
    assert same(again.rates.rate, estimates("rate/tumble_lag").rates.rate)
    slam = tumble.read_estimate(tumble.estimate(tmp_path / "own.h5", "slam/tumble_lag", tmp_path / "slam"))
    assert same(slam.sweep_poses.position, estimates("slam/tumble_lag").sweep_poses.position)
    back = tumble.read(tmp_path / "own.h5")
    assert tumble.read(recordings["hill"], truth=False).truth is None
    for own, first in zip(back.imus, hill.imus, strict=True):
        assert same(own.gyro, first.gyro) and own.name == first.name and own.gyro_range_rad_s == first.gyro_range_rad_s
        assert np.array_equal(own.clip_flags, first.clip_flags) and np.array_equal(own.T_BI, first.T_BI)
    assert same(back.sweeps.position, hill.sweeps.position) and np.array_equal(back.sweeps[3].offset_ns, hill.sweeps[3].offset_ns)


def contents(path):
    """Returns every dataset and attribute of a file."""
    h5py = importlib.import_module("h5py")
    found = {}

    def see(name, thing):
        for key, value in thing.attrs.items():
            found[f"{name}@{key}"] = value.decode() if isinstance(value, bytes) else value
        if isinstance(thing, h5py.Dataset):
            rows = thing[()]
            found[name] = thing.dtype, rows.shape, rows.tobytes()

    with h5py.File(path) as file:
        see("", file)
        file.visititems(see)
    return {name: value for name, value in found.items() if not name.endswith("@digest")}


@pytest.mark.parametrize("name", ["hill", "slip", "twirl"])
def test_what_the_program_wrote_is_written_again(recordings, name, tmp_path):
    """A file that is read and written has the same contents, except the digests. The test also covers later additions to the format."""
    own = tmp_path / "own.h5"
    tumble.write(own, tumble.read(recordings[name]))
    first, again = contents(recordings[name]), contents(own)
    assert first.keys() == again.keys() and len(first) > 100
    assert [place for place, value in first.items() if again[place] != value] == []
    with importlib.import_module("h5py").File(own, "r+") as file:
        file["truth/label"][7] += 1
    assert [place for place, value in first.items() if contents(own)[place] != value] == ["truth/label"], "the negative control"


@pytest.mark.parametrize(("name", "method"), [("hill", "slam/tumble_lag"), ("hill", "rate/tumble_lag"), ("twirl", "attitude/vqf"),
                                              ("slip", "position/tumble_live")])
def test_program_scores_against_the_truth_that_we_write(recordings, name, method, tmp_path):
    """Both files give the same scores, including those of the map and of clipped samples."""
    tumble.write(tmp_path / "own.h5", tumble.read(recordings[name]))
    files = {"first": recordings[name], "again": tmp_path / "own.h5"}
    folders = [tumble.estimate(path, method, tmp_path / key) for key, path in files.items()]
    scores = [tumble.score(folder, path) for folder in folders for path in files.values()]
    assert len(scores[0]) > 3 and any(value is not None for value in scores[0].values())
    assert scores == [scores[0]] * 4
    if method == "slam/tumble_lag":
        assert scores[0]["map_overlap"] > 0.5


def test_a_recording_that_was_changed_is_scored(hill, recordings, tmp_path):
    """Halves the range of the gyro in a recording, whose truth contains the unclipped readings."""
    changed = tumble.read(recordings["hill"])
    for imu, true in zip(changed.imus, changed.truth.imus, strict=True):
        rail = 0.5 * np.abs(imu.gyro).max()
        imu.gyro = np.clip(imu.gyro, -rail, rail)
        imu.clip_flags = ((np.abs(imu.gyro) >= rail) @ [1, 2, 4]).astype(np.uint8)
        imu.gyro_range_rad_s = rail
        assert len(true.gyro_unclipped) == len(imu)
    changed.scenario = "hill_of_half_the_range"
    tumble.write(tmp_path / "changed.h5", changed)
    scores = tumble.score(tumble.estimate(tmp_path / "changed.h5", "rate/raw", tmp_path / "changed"), tmp_path / "changed.h5")
    imu, true = changed.imus[0], changed.truth.imus[0]
    clipped = (imu.gyro != true.gyro_unclipped).any(axis=1)
    assert np.count_nonzero(clipped) > 1.2 * np.count_nonzero((hill.imus[0].gyro != true.gyro_unclipped).any(axis=1)) > 0
    error = np.linalg.norm(imu.gyro - true.rate, axis=1)[clipped]
    assert scores["rate_error_clipped_median_rad_s"] == pytest.approx(np.median(error), rel=1e-2)
    tumble.write(tmp_path / "blind.h5", changed, truth=False)
    with pytest.raises(tumble.TumbleError, match="contains no truth"):
        tumble.score(tmp_path / "changed", tmp_path / "blind.h5")


def test_program_scores_our_poses(hill, recordings, tmp_path):
    tumble.write_tum(tmp_path / "own.tum", tumble.tumbling(hill).poses)
    scores = tumble.score(tmp_path / "own.tum", recordings["hill"], kind="slam")
    assert 0.0 <= scores["ate_m"] < 0.5
    lost = tumble.read_tum(tmp_path / "own.tum")
    lost.position *= 3.0
    tumble.write_tum(tmp_path / "lost.tum", lost)
    assert tumble.score(tmp_path / "lost.tum", recordings["hill"], kind="slam")["ate_m"] > 10 * scores["ate_m"]


RAW = textwrap.dedent('''
    import tumble

    def rate(recording):
        return recording.imus[0].gyro

    if __name__ == "__main__":
        tumble.serve("rate", rate)
''')


def test_a_function_is_a_method(tmp_path):
    """A Python method that returns the gyro has the same errors as the program's raw gyro."""
    (tmp_path / "mine.py").write_text(RAW)
    mine = tumble.describe_method(tmp_path / "mine.yaml", "mine", "rate", tmp_path / "mine.py", doc="it's the gyro", robots=["rig"])
    frame = tumble.sweep("bare", tmp_path / "a.db", seeds=(1, 2), methods=["rate/raw", mine], jobs=2)
    table = frame[frame.metric == "rate_error_clipped_median_rad_s"].pivot(index="seed", columns="method", values="value")
    assert set(frame.status) == {"ok"} and len(table) == 2
    assert (table["mine"] == table["raw"]).all() and (table["raw"] > 0.1).all()
    assert frame.equals(tumble.results(tmp_path / "a.db"))
    (tmp_path / "mine.py").write_text(RAW.replace("imus[0].gyro", "imus[0].gyro[:-1]"))
    broken = tumble.sweep("bare", tmp_path / "b.db", seeds=(1, 1), methods=[mine], jobs=1)
    assert set(broken.status) == {"crashed"} and not any("error" in metric for metric in broken.metric), "the negative control"


def test_attitudes_of_a_function(recordings, tmp_path):
    (tmp_path / "mine.py").write_text(textwrap.dedent('''
        import tumble
        tumble.serve("attitude", lambda recording: tumble.Vqf().add_imu(*recording.imus[0].samples))
    '''))
    mine = tumble.describe_method(tmp_path / "mine.yaml", "mine", "attitude", tmp_path / "mine.py")
    own = tumble.read_estimate(tumble.estimate(recordings["hill"], mine, tmp_path / "own"))
    assert own.kind == "attitude" and len(own.poses) > 900


def test_run(tmp_path):
    expected = tumble.run("hill", seed=1, methods=["rate/raw"], settings={})
    assert expected["scenario"] == "hill"
    with pytest.raises(tumble.TumbleError) as caught:
        tumble.run("hill", methods=["rate/missing"])
    assert (caught.value.trouble, caught.value.value) == ("program", 2) and "missing" in str(caught.value)
    with pytest.raises(tumble.TumbleError, match="lag"):
        tumble.run("hill", methods=["rate/tumble_lag"], settings={"rate/tumble_lag.lag": 1})


def test_no_program(monkeypatch):
    monkeypatch.setenv("TUMBLE_PROGRAM", "/nowhere/tumble")
    with pytest.raises(tumble.TumbleError) as caught:
        tumble.program()
    assert caught.value.trouble == "program"


def test_results_without_pandas(tmp_path, monkeypatch):
    tumble.call("sweep", "bare", "--seeds", "1..1", "--method", "rate/raw", "--db", tmp_path / "a.db", "--examples", 0)
    assert {row["metric"] for row in tumble.score_rows(tmp_path / "a.db")} >= {"rate_error_clipped_median_rad_s"}
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError):
        tumble.results(tmp_path / "a.db")
    with pytest.raises(tumble.TumbleError, match="not a results database|does not exist"):
        tumble.score_rows(tmp_path / "none.db")
    (tmp_path / "text.db").write_text("hello " * 500)
    with pytest.raises(tumble.TumbleError, match="not a results database"):
        tumble.score_rows(tmp_path / "text.db")
    assert importlib.util.find_spec("tumble")


def test_files_are_stored_as_the_programs_own(recordings, tmp_path):
    """Compares chunks, filters and type of each dataset, so that a file that was read and written is not larger."""
    h5py = pytest.importorskip("h5py")
    for name in ("hill", "slip", "twirl"):  # files written by the program; other tests add files written by Python
        first, again = recordings[name], tmp_path / f"{name}.h5"
        tumble.write(again, tumble.read(first))

        def stored(path):
            out = {}
            with h5py.File(path) as file:
                file.visititems(lambda place, at: out.update({place: (at.dtype, at.shape, at.chunks, at.compression, at.compression_opts,
                                                                      at.shuffle)}) if isinstance(at, h5py.Dataset) else None)
            return out

        assert stored(again) == stored(first) and len(stored(first)) > 20
        assert any(compression == "gzip" for _, _, _, compression, _, _ in stored(again).values()), "the control"
        assert abs(again.stat().st_size / first.stat().st_size - 1.0) < 0.005


def test_odometry_of_a_bag_equals_the_command(recordings, tmp_path):
    bag = tmp_path / "hill.mcap"
    tumble.call("export", recordings["hill"], "-o", bag)
    tumble.call("odometry", bag, "-o", tmp_path / "command")
    expected = tumble.read_estimate(tmp_path / "command")
    own = tumble.odometry(bag)
    assert own.method == "tumble" and own.status == "ok" and own.health == expected.health
    assert same(own.poses.position, expected.poses.position) and same(own.poses.quaternion, expected.poses.quaternion)
    live = tumble.odometry(bag, tmp_path / "live", live=True)
    assert live.method == "tumble_live" and (tmp_path / "live" / "map.pcd").exists()
    assert not np.array_equal(live.poses.position, own.poses.position), "the negative control"
    base = tumble.odometry(bag, live=True, base_frame="body")
    arm = np.linalg.norm(tumble.read(recordings["hill"]).imus[0].T_BI[:3, 3])
    assert base.frame == "base" and np.allclose(np.linalg.norm(base.poses.position - live.poses.position, axis=1), arm, atol=1e-9)
    with pytest.raises(tumble.TumbleError, match="options"):
        tumble.odometry(bag, options="--live")


def test_odometry_warns_of_an_estimate_that_its_health_rejects(recordings, tmp_path):
    recording = tumble.read(recordings["hill"])
    recording.imus[0].accel *= 0.8
    tumble.write(tmp_path / "low.h5", recording)
    with pytest.warns(UserWarning, match="diverged: health: "):
        assert len(tumble.odometry(tmp_path / "low.h5").poses.position) > 100
