"""What the FMU is judged by: own references, closed forms, scenes, errors."""
