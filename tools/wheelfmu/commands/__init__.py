"""The commands under scripts/, a module each, whose docstring is its help.

What is typed is read by OPTIONS, of one parser for all, or by `reads`, with its help by `usage`; NEEDS, or `needs`, are
the words of set-up for it; `main` carries it out and returns the exit status. What stands at the head of a module is of
the standard library alone: arguments are read before anything is installed. PART is the folder that a command is of,
which may have been deleted; one that FINISHES ends itself at Ctrl-C; one that STAYS works in the caller's folder, all
others in the project's.
"""
