"""Prints the name and reason of each skipped test in a JUnit report of ctest."""
import re
import sys
import xml.etree.ElementTree as ElementTree

for case in ElementTree.parse(sys.argv[1]).getroot().iter("testcase"):
    if case.get("status") not in ("notrun", "disabled") and case.find("skipped") is None:
        continue
    output = case.findtext("system-out") or ""
    # GoogleTest prints "FILE:LINE: Skipped" and then the reason; a test without its packages "skipped: REASON".
    found = re.search(r"Skipped\n+(.+)", output) or re.search(r"skipped: (.+)", output)
    print(f"  {case.get('name')}: {found.group(1).strip() if found else 'no reason given'}")
