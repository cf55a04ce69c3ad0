# SPDX-License-Identifier: BSD-3-Clause
"""Calls one function of a Python file with the sensor data of a recording: runner FILE FUNCTION KIND SENSORS ANSWER.

The program starts this script for a method that is a Python function (EXTERNAL.md). The script only needs numpy. SENSORS and ANSWER are
file descriptors of shared memory, which contains the length of a JSON text (8 bytes, little endian), the text, and arrays from the next
multiple of 64 bytes (python_method.hpp).
"""
import importlib.util
import json
import mmap
import numbers as kinds
import os
import struct
import sys
import traceback
import types

import numpy as np

ALIGNMENT = 64
TOLD_MAX = 1500  # number of reported characters at the end of a traceback
UNIT_TOLERANCE = 1e-2  # largest deviation of a quaternion's norm from 1, as for a TUM file
ROUNDING_NS = 1000  # points up to this time after the end of their sweep get the time of the end
SYMMETRY_TOLERANCE = 1e-3  # largest asymmetry of a covariance, relative to its diagonal; accepts single precision


class Refused(Exception):
    """The function returned an invalid result."""


class Lidar(types.SimpleNamespace):
    """A lidar is a sequence of sweeps: len(lidar), lidar[k], `for sweep in lidar`."""

    def __len__(self):
        return len(self.sweep_start_ns)

    def __getitem__(self, index):
        if not -len(self) <= index < len(self):
            raise IndexError(f"sweep {index} of {len(self)}")
        index %= len(self)
        start_ns, rows = int(self.sweep_start_ns[index]), slice(int(self.sweep_first[index]), int(self.sweep_first[index + 1]))
        length_ns, offset_ns = self.sweep_period_ns * (self.point_times == "measured"), self.offset_ns[rows]
        if index + 1 < len(self) and int(self.sweep_start_ns[index + 1]) - start_ns < length_ns:
            length_ns = int(self.sweep_start_ns[index + 1]) - start_ns
            if len(offset_ns) > 0 and offset_ns.max() > length_ns:
                rows = rows.start + np.flatnonzero(offset_ns <= length_ns + ROUNDING_NS)
                offset_ns = np.minimum(self.offset_ns[rows], length_ns).astype(offset_ns.dtype)
        return types.SimpleNamespace(start_ns=start_ns, end_ns=start_ns + length_ns, position=self.position[rows],
                                     offset_ns=offset_ns, ring=self.ring[rows], intensity=self.intensity[rows])


def read_sensors(descriptor):
    """Returns the recording: imus, lidars, series, robot, sphere_radius_m, gravity_m_s2. Arrays are read-only views of the shared memory."""
    memory = mmap.mmap(descriptor, 0, flags=mmap.MAP_PRIVATE, prot=mmap.PROT_READ)  # some kernels refuse MAP_SHARED for sealed memory
    (length,) = struct.unpack_from("<Q", memory)
    data = -(-(8 + length) // ALIGNMENT) * ALIGNMENT

    def made(node):
        if isinstance(node, list):
            return [made(each) for each in node]
        if not isinstance(node, dict):
            return node
        if node.keys() == {"dtype", "shape", "offset"}:
            count = int(np.prod(node["shape"]))
            return np.frombuffer(memory, node["dtype"], count, data + node["offset"]).reshape(node["shape"]) if count else (
                np.zeros(node["shape"], node["dtype"]))
        return {name: made(value) for name, value in node.items()}

    told = made(json.loads(memory[8:8 + length]))
    for imu in told["imus"]:
        imu["earth_field_t"] = None if imu["earth_field_t"] is None else np.array(imu["earth_field_t"])
    told["imus"] = [types.SimpleNamespace(**imu, lever_arm_m=imu["T_BI"][:3, :3].T @ imu["T_BI"][:3, 3]) for imu in told["imus"]]
    told["lidars"] = [Lidar(**lidar) for lidar in told["lidars"]]
    told["series"] = [types.SimpleNamespace(**each) for each in told["series"]]
    return types.SimpleNamespace(**told)


def unmasked(name, given):
    """Converts `given` to an array; raises Refused for masked values."""
    if any(np.ma.is_masked(each) for each in (given, *(given if isinstance(given, (list, tuple)) else ()))):
        raise Refused(f"{name} is masked in places; all values must be numbers")
    return np.asarray(given)


def numbers(name, given, *shape):
    """Converts `given` to finite float64 of the given shape; None allows any size. Raises Refused for types that lose information, such as complex."""
    try:
        found = unmasked(name, given)
        real = found.dtype.kind in "iuf" or (
            found.dtype.kind == "O" and all(isinstance(each, kinds.Real) and not isinstance(each, bool) for each in found.flat))
        if not real:
            raise TypeError
        out = found.astype(np.float64)
    except (TypeError, ValueError, OverflowError):
        what = f"an array of {given.dtype}" if isinstance(given, np.ndarray) else f"a {type(given).__name__}"
        raise Refused(f"{name} must be an array of numbers; it is {what}") from None
    if out.ndim != len(shape) or any(wanted not in (None, size) for size, wanted in zip(out.shape, shape)):
        bound = ", ".join("N" if size is None else str(size) for size in shape)
        raise Refused(f"{name} has the shape {out.shape}; it must be ({bound})")
    bad = np.flatnonzero(~np.isfinite(out).all(axis=tuple(range(1, out.ndim))))
    if len(bad):
        raise Refused(f"{name}[{bad[0]}] is {out[bad[0]].tolist()}; it must be finite ({len(bad)} of {len(out)} rows are not)")
    return out


def instants(given):
    out = unmasked("time_ns", given)
    if out.ndim != 1 or out.dtype.kind not in "iu":
        raise Refused(f"time_ns is {out.dtype} of the shape {out.shape}; it must be integers of the shape (N,)")
    if len(out) == 0:
        raise Refused("time_ns is empty; it must contain at least one time")
    back = np.flatnonzero(np.diff(out.astype(np.int64)) <= 0)
    if len(back):
        raise Refused(f"time_ns[{back[0] + 1}] is {out[back[0] + 1]}; it must be larger than the previous time, {out[back[0]]}")
    return out.astype(np.int64)


def covariances(given, count):
    out = numbers("covariance", given, count, 3, 3)
    deviation = np.sqrt(np.maximum(np.diagonal(out, axis1=1, axis2=2), 0.0))
    apart = np.abs(out - out.transpose(0, 2, 1)) > SYMMETRY_TOLERANCE * deviation[:, :, None] * deviation[:, None, :]
    bad = np.flatnonzero(apart.any(axis=(1, 2)))
    if len(bad):
        raise Refused(f"covariance[{bad[0]}] is {out[bad[0]].tolist()}; it must be symmetric ({len(bad)} of {count} matrices are not)")
    return out


def parts(returned, names):
    """Returns the parts of the result by name, from attributes or from a tuple in the order of `names`. The last part may be missing or None."""
    if returned is None:
        raise Refused(f"nothing was returned; the function must return {', '.join(names)}")
    if hasattr(returned, names[0]):
        return {name: getattr(returned, name) for name in names if getattr(returned, name, None) is not None}
    given = returned if isinstance(returned, tuple) else (returned,)
    if len(given) > 1 and given[-1] is None:
        given = given[:-1]
    if len(given) > len(names):
        raise Refused(f"{len(given)} values were returned; the function may return at most {len(names)}: {', '.join(names)}")
    return dict(zip(names, given))


def rates(returned, count):
    given = parts(returned, ("rate", "covariance"))
    out = {"rate": numbers("rate", given.get("rate"), count, 3)}
    if "covariance" in given:
        out["covariance"] = covariances(given["covariance"], count)
    return out


def poses(returned, names):
    given = parts(returned, names)
    missing = [name for name in names[:names.index("quaternion") + 1] if name not in given]
    if missing:
        raise Refused(f"the returned value has no {missing[0]}; the function must return {', '.join(names)} (a tuple, or an object with these attributes)")
    out = {"time_ns": instants(given["time_ns"])}
    count = len(out["time_ns"])
    if "position" in names:
        out["position"] = numbers("position", given["position"], count, 3)
    out["quaternion"] = numbers("quaternion", given["quaternion"], count, 4)
    norm = np.linalg.norm(out["quaternion"], axis=1)
    wrong = np.flatnonzero(np.abs(norm - 1.0) > UNIT_TOLERANCE)
    if len(wrong):
        raise Refused(f"quaternion[{wrong[0]}] has the norm {norm[wrong[0]]:.6g}; it must be 1 (difference at most {UNIT_TOLERANCE:g})")
    if "map" in given:
        out["map"] = numbers("map", given["map"], None, 3).astype(np.float32)
    return out


def arrays_of(kind, returned, recording):
    if kind == "rate":
        return rates(returned, len(recording.imus[0].time_ns) if recording.imus else 0)
    return poses(returned, {"attitude": ("time_ns", "quaternion"), "position": ("time_ns", "position", "quaternion")}.get(
        kind, ("time_ns", "position", "quaternion", "map")))


def told(error):
    """Returns the traceback without the lines of this file."""
    whole = traceback.TracebackException.from_exception(error)
    for each in (whole, whole.__cause__, whole.__context__):
        if each is not None:
            each.stack = traceback.StackSummary.from_list([line for line in each.stack if line.filename != "<string>"
                                                           and not line.filename.startswith("<frozen")])
    return "".join(whole.format()).strip()[-TOLD_MAX:]


def called(file, function, recording):
    """Calls the function of the file. The folder of the file is the first entry of sys.path, as for a script."""
    sys.path[0] = os.path.dirname(file)
    spec = importlib.util.spec_from_file_location(os.path.splitext(os.path.basename(file))[0], file)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    if not callable(getattr(module, function, None)):
        raise Refused(f"{os.path.basename(file)} has no function '{function}'")
    return getattr(module, function)(recording)


def answer(descriptor, text, arrays):
    offset = 0
    for name, array in arrays.items():
        text.setdefault("arrays", {})[name] = {"dtype": array.dtype.str, "shape": array.shape, "offset": offset}
        offset += -(-array.nbytes // ALIGNMENT) * ALIGNMENT
    head = json.dumps(text).encode()
    with open(descriptor, "wb", closefd=False) as out:
        written = out.write(struct.pack("<Q", len(head)) + head)
        out.write(bytes(-written % ALIGNMENT))
        for array in arrays.values():
            out.write(np.ascontiguousarray(array).tobytes())
            out.write(bytes(-array.nbytes % ALIGNMENT))


def main(file, function, kind, source, sink):
    try:
        recording = read_sensors(int(source))
        arrays = arrays_of(kind, called(file, function, recording), recording)
        answer(int(sink), {}, arrays)
    except Refused as error:
        answer(int(sink), {"refused": f"{function}: {error}"}, {})
    except BaseException as error:  # the function may also call sys.exit()
        print(told(error), file=sys.stderr)
        answer(int(sink), {"raised": told(error)}, {})


if __name__ == "__main__":
    main(*sys.argv[1:])
