"""The commands' code: floors from fmu below to the commands above; an upper one imports lower ones only."""
