"""The 3D page of recorded motions, and the lesson."""
