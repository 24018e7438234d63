import numpy as np
import pytest
from scipy.spatial.transform import Rotation


@pytest.fixture(scope="session")
def link_poses():
    """The textbook chain: (4, 4) poses in B of the base, of each joint frame, and of the flange."""

    def pose(xyz, rpy) -> np.ndarray:
        X = np.eye(4)
        X[:3, :3] = Rotation.from_euler("xyz", rpy).as_matrix()
        X[:3, 3] = xyz
        return X

    def poses(description, q) -> list[np.ndarray]:
        chain = [np.eye(4)]
        for joint, angle in zip(description.joints, q, strict=True):
            chain.append(
                chain[-1] @ pose(joint.origin_xyz, joint.origin_rpy) @ pose((0, 0, 0), (0, 0, angle))
            )
        return [*chain, chain[-1] @ pose(description.flange_xyz, description.flange_rpy)]

    return poses
