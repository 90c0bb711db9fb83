"""terminalsAndIcons.xml: the hub is a terminal whose members are variables, inputs and outputs."""

from xml.etree import ElementTree

from unit import DESCRIPTION, FOLDER, verdict

tree = ElementTree.parse(f"{FOLDER}/terminalsAndIcons/terminalsAndIcons.xml")
causality = {v.name: v.causality for v in DESCRIPTION.modelVariables}
(hub,) = tree.iter("Terminal")
kinds = [causality.get(member.get("variableName")) for member in hub.iter("TerminalMemberVariable")]
inputs, outputs = kinds.count("input"), kinds.count("output")
every = [*causality.values()].count("input")
verdict(inputs == every and inputs + outputs == len(kinds), f"one terminal, {inputs} inputs and {outputs} outputs")
