"""What follows from a list of variables: numbers, GUID and dependencies of an FMI 2.0 description (numbering,
measuring). The command is scripts/variables."""
