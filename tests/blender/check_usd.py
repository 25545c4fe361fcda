"""Opens a USD stage with USD's own library and holds it against all rules that come with it. Exits with 1 over any.

Needs `pip install usd-core`.
"""

import sys

from pxr import Usd, UsdValidation

stage = Usd.Stage.Open(sys.argv[1])
rules = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
broken = UsdValidation.ValidationContext(rules).Validate(stage)
meshes = [prim.GetPath().pathString for prim in stage.Traverse() if prim.GetTypeName() == "Mesh"]
for error in broken:
    print(error.GetName(), error.GetMessage())
print(f"{sys.argv[1]}: meshes {', '.join(meshes)}; {len(rules)} rules, {len(broken)} broken")
sys.exit(1 if broken or not meshes else 0)
