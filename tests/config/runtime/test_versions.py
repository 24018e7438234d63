"""Bundles of older versions are read, and written as they are today."""

import json

import pytest
from benchmarks.bundle_mutations import seal
from config.runtime.bundles import OLD_GAINS, example, of_version_1, of_version_2, of_version_3

from contactbench.pipeline.config.runtime import ConfigError, RuntimeConfig


def assert_written_as_version_4(found):
    assert RuntimeConfig.from_files(found.encoded()).model == found.model
    assert json.loads(found.encoded()["contactbench.json"])["version"] == 4


def test_a_bundle_of_version_1_keeps_its_gains_and_is_written_as_version_4():
    found = RuntimeConfig.from_files(of_version_1(example().encoded()))
    # What was left open then, as it was taken then: it stays, whatever the defaults become.
    assert found.model.controller.model_dump() == json.loads(
        '{"variant":"aware","desired_force_N":5.0,"period_s":0.02,"servo_lag_s":0.0,'
        '"force":{"mass_kg":1.0,"damping_Nspm":80.0,"stiffness_Npm":0.5,"gain_per_s":6.0},'
        '"angle":{"inertia":[0.05,0.05],"damping":[1.0,1.0],"stiffness":[0.25,0.25],"gain_per_s":[6.0,6.0],'
        '"settling_s":0.04},"lead":{"bandwidth_per_s":[20.0,13.0,13.0],"smoothing_s":0.08,"lean_rad":0.025,"lean_s":0.8},'
        '"touch":{"approach_speed_mps":0.006,"approach_travel_m":0.05,"retract_speed_mps":0.06,"retract_travel_m":0.03,'
        '"touch_force_N":0.7,"low_force_N":0.7,"ramp_s":0.5,"probing_m":0.00015,"attempts":3},'
        '"tool":{"left_force_N":0.01,"left_torque_Nm":0.0005,"taring_s":0.5,"gyration_m":0.035},'
        '"watch":{"stale_s":0.06,"give_up_s":0.2,"following_s":0.05,"max_tilt_rad":0.5}}'
    )
    # It was verified with rules that are gone, and says so.
    assert example().model.verified
    assert not found.model.verified
    assert "before version 3 were verified with other rules" in found.model.provenance.stale[-1]
    assert "of version 1, read as version 4" in found.notes[0]
    assert RuntimeConfig.from_files(example().encoded()).notes == ()
    assert_written_as_version_4(found)
    bare = RuntimeConfig.from_files(of_version_1(example().encoded(), None))
    assert bare.model.controller is None


@pytest.mark.parametrize(
    ("controller", "words"),
    [
        ({**OLD_GAINS, "extra": 1}, "version 1 cannot be migrated"),
        ({name: value for name, value in OLD_GAINS.items() if name != "angle_inertia"}, "cannot be migrated"),
        ({**OLD_GAINS, "angle_inertia": [0.1, 0.2]}, "controller.angle.inertia"),
        ({**OLD_GAINS, "angle_damping": 0.0}, "controller.angle.damping.0 is 0.0"),
        ({**OLD_GAINS, "force_mass_kg": "1"}, "controller.force.mass_kg is '1'"),
        ([], "cannot be migrated"),
        (3, "cannot be migrated"),
    ],
)
def test_a_wrong_controller_of_version_1_is_refused(controller, words):
    with pytest.raises(ConfigError, match=words):
        RuntimeConfig.from_files(of_version_1(example().encoded(), controller))


def test_a_bundle_of_version_2_gets_the_model_of_a_touch_and_is_written_as_version_4():
    part = example().model.regions[0].model_dump(exclude={"odds", "untouchable"})
    empty = [{**part, "rank": rank, "name": f"empty {rank}", "facets": 0} for rank in (2, 3, 4)]
    found = RuntimeConfig.from_files(of_version_2(example().encoded(), regions=[part, *empty]))
    # As it was taken when version 3 came: it stays, whatever the defaults become.
    assert found.model.touch.model_dump() == {
        "torsion_arm_m": 0.001,
        "model_error": {"force_N": [0.05] * 3, "torque_Nm": [0.001] * 3, "measured": False},
        "mesh_deviation_m": 0.0,
        "mesh_curved": True,
    }
    before = example().model.gates.model_dump()
    assert found.model.gates.model_dump() == {
        **{name: before[name] for name in ("min_force_N", "friction_angle_rad", "ambiguity_distance_m")},
        **{name: before[name] for name in ("follow_distance_m", "recent_samples", "max_age_s", "saturation")},
        "implausible_misfit": 10.827566170662935,
        "rival_odds": 100.0,
        "first_odds": 7.38905609893065,
        "follow_odds": 1000.0,
        "region_only": False,
        "accept_by_region": True,
    }
    assert [(each.odds, each.untouchable) for each in found.model.regions] == [
        (1000.0, False),
        (100.0, False),
        (10.0, False),
        (10.0, False),
    ]
    assert found.model.noise == example().model.noise.model_copy(update={"orientation_rad": None})
    assert found.model.controller == example().model.controller
    assert_written_as_version_4(found)


def old_gates(**changes):
    return json.loads(of_version_2(example().encoded())["contactbench.json"])["gates"] | changes


@pytest.mark.parametrize(
    "changes",
    [
        {"gates": {name: value for name, value in old_gates().items() if name != "rival_sigmas"}},
        {"gates": old_gates(rival_odds=100.0)},
        {"gates": []},
        {"touch": {}},
        {"regions": example().model.to_json()["regions"]},
        {"regions": 3},
    ],
)
def test_what_version_2_never_was_is_refused(changes):
    with pytest.raises(ConfigError, match="version 2 cannot be migrated"):
        RuntimeConfig.from_files(of_version_2(example().encoded(), **changes))


def test_a_bundle_of_version_3_stands_upright_and_is_written_as_version_4():
    files = of_version_3(example().encoded())
    found = RuntimeConfig.from_files(files)
    assert found.model.world.down_W == [0.0, 0.0, -1.0]
    assert found.model.zero.model_dump() == {"measured": None, "drift": None}
    assert found.model.noise.orientation_rad is None
    assert found.model.checks.model_dump() == {"known_weight": None, "known_touch": None}
    assert found.model.verified
    assert found.files == {
        name: data for name, data in files.items() if name not in ("contactbench.json", "contactbench.sha256")
    }
    assert_written_as_version_4(found)


def test_only_since_version_4_gravity_has_to_be_near_down():
    gravity = example().model.gravity.model_dump() | {"gravity_W_N": [5.8, 0.0, -2.1]}  # 70 degrees from down
    new = json.loads(example().encoded()["contactbench.json"]) | {"gravity": gravity}
    with pytest.raises(ConfigError, match="more than 60 degrees"):
        RuntimeConfig.from_files(seal({**example().encoded(), "contactbench.json": json.dumps(new).encode()}))
    with pytest.raises(ConfigError, match=r"noise\.wrench_covariance"):  # which comes after gravity
        RuntimeConfig.from_files(of_version_3(example().encoded(), gravity=gravity))


def frames(**changes):
    return json.loads(of_version_3(example().encoded())["contactbench.json"])["frames"] | changes


@pytest.mark.parametrize(
    "changes",
    [
        {"world": {"down_W": [0.0, 0.0, -1.0]}},
        {"zero": None},
        {"checks": None},
        {"frames": frames(world="W")},
        {"frames": []},
        {"noise": example().model.noise.model_dump()},
        {"noise": 3},
    ],
)
def test_what_version_3_never_was_is_refused(changes):
    with pytest.raises(ConfigError, match="version 3 cannot be migrated"):
        RuntimeConfig.from_files(of_version_3(example().encoded(), **changes))
