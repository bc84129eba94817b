"""Validates documents of PML, LML and MML: validate_models.py SCHEMAS FILE …; ends with 1 if one is not valid."""
import sys
from pathlib import Path

from lxml import etree

SCHEMA = "http://www.w3.org/2001/XMLSchema"
LOADS = "http://www-timc.imag.fr/load"
KINDS = {"physicalModel": "pml/PhysicalModel", "monitoringIn": "mml/MonitorIn", "monitoringOut": "mml/MonitorOut"}


def schema_of(root, schemas):
    if root in KINDS:
        return etree.parse(schemas / f"{KINDS[root]}.xsd")
    # No schema of the language names all kinds of loads.
    files = ["Loads", "Translation", "Rotation", "Force", "Pressure", "Acceleration"]
    parts = "".join(f'<s:include schemaLocation="{(schemas / "lml" / f).as_uri()}.xsd"/>' for f in files)
    text = f'<s:schema xmlns:s="{SCHEMA}" targetNamespace="{LOADS}" elementFormDefault="qualified">{parts}</s:schema>'
    return etree.fromstring(text)


good = True
for path in sys.argv[2:]:
    document = etree.parse(path)
    root = etree.QName(document.getroot()).localname
    schema = etree.XMLSchema(schema_of(root, Path(sys.argv[1]).resolve()))
    if not schema.validate(document):
        good = False
        print(path, *schema.error_log, sep="\n  ")
sys.exit(not good)
