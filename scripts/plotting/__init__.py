"""Drawing tools shared by figures.py and picture.py; nothing here computes dynamics."""
