# SPDX-License-Identifier: BSD-3-Clause
"""Estimators and mapping for robots that tumble and roll: clipping gyros, motion-distorted lidar sweeps, slipping spheres.

Inputs and outputs are numpy arrays. Times are int64 nanoseconds, all other quantities are in SI units. Quaternions are Hamilton,
x y z w, and rotate sensor or body axes to the world (z up). Invalid input raises TumbleError, with field, value and bound.
`parameters()` of a class lists its keywords.

Odometry        TumblingOdometry (an IMU that may clip and a lidar), RollingOdometry (IMUs in a sphere), sheets: data sheets of sensors
Rates           MotionRegimeSmoother, AngularRateSmoother, HandHeldSmoother, Saave (whole recordings), MotionRegimeStream, AngularRateStream (live), find_rails
Attitude        TumbleAttitude, Vqf, Strapdown
Sphere          RollingOdometry (live, lag or whole recording), RollingSmoother
Mapper          LidarInertialOdometry
Recordings      read and write recordings with ground truth; rate, tumbling and rolling process a whole recording
Data sets       read_broad, read_repoimu, read_airbrakes
Estimates       read_tum, write_tum, read_estimate
Figures         plot (Matplotlib); point_errors: distances of returns from their true positions
The program     odometry (trajectory and map from a bag), record, run, estimate, score, sweep, results; serve and describe_method add a Python function as a method
"""
import importlib.metadata

from ._tumble import (
    Attitudes,
    HandHeldReport,
    HandHeldSmoother,
    HealthFinding,
    ImuDataSheet,
    LidarInertialOdometry,
    LidarDataSheet,
    MapPoints,
    Parameter,
    Pose,
    Poses,
    SaturationPlane,
    Rails,
    Rates,
    AngularRateReport,
    AngularRateSmoother,
    AngularRateSource,
    AngularRateStream,
    RegimeReport,
    MotionRegimeSmoother,
    MotionRegimeStream,
    BodyImuCalibration,
    ContactMode,
    RollingOdometry,
    RollingPoses,
    RollingSmoother,
    Saave,
    SphereUnit,
    Strapdown,
    Sweep,
    LidarImuCalibration,
    SweepResult,
    SweepScale,
    SweepVerdict,
    TumbleAttitude,
    TumblingOdometry,
    Vqf,
    find_rails,
    rails_parameters,
)
from . import plot, sheets
from .errors import TumbleError
from .datasets import read_airbrakes, read_broad, read_repoimu
from .estimates import Estimate, RateTable, Trajectory, read_estimate, read_tum, write_tum
from .method import describe_method, serve
from .placing import point_errors
from .program import ProgramError, call, estimate, odometry, program, record, results, run, score, score_rows, sweep
from .recordings import Imu, Lidar, Recording, Series, read, write
from .processing import Tumble, rate, rolling, sheet_of, tumbling, tumbling_options
from .truth import Contacts, ImuTruth, LidarTruth, SeriesTruth, Truth

__version__ = importlib.metadata.version("tumble")
__all__ = [
    "Attitudes", "HandHeldReport", "HandHeldSmoother", "Contacts", "Estimate", "HealthFinding", "Imu", "ImuDataSheet", "ImuTruth", "Lidar",
    "LidarInertialOdometry", "LidarDataSheet", "LidarTruth", "MapPoints", "Parameter", "Pose", "Poses", "ProgramError", "SaturationPlane", "Rails", "AngularRateReport", "AngularRateSmoother", "AngularRateSource",
    "AngularRateStream", "RateTable", "Rates", "Recording", "RegimeReport", "MotionRegimeSmoother", "MotionRegimeStream", "BodyImuCalibration", "ContactMode", "RollingOdometry",
    "RollingPoses", "RollingSmoother", "Saave", "Series", "SeriesTruth", "SphereUnit", "Strapdown", "Sweep", "LidarImuCalibration", "SweepResult", "SweepScale", "SweepVerdict", "Trajectory",
    "Truth", "Tumble", "TumbleAttitude", "TumbleError", "TumblingOdometry", "Vqf", "call", "describe_method", "estimate",
    "find_rails", "odometry", "plot", "point_errors", "program", "rails_parameters", "rate", "read", "read_airbrakes", "read_broad", "read_estimate", "read_repoimu", "read_tum", "record", "results", "rolling", "run",
    "score", "score_rows", "serve", "sheet_of", "sheets", "sweep", "tumbling", "tumbling_options", "write", "write_tum",
]
