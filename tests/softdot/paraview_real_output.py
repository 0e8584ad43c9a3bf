"""Run by pvpython: open the collections of a real run, check times, arrays and the press itself, and draw."""

import sys

from paraview.simple import (
    Clip,
    ColorBy,
    GetActiveViewOrCreate,
    GetAnimationScene,
    PVDReader,
    Render,
    SaveScreenshot,
    Show,
    WarpByVector,
)

folder, picture, depth, steps = sys.argv[1], sys.argv[2], float(sys.argv[3]), int(sys.argv[4])
TOP_MM = 2.0 + 0.028 + 0.5 + 1.0  # of the default segment at rest
ARRAYS = {
    "segment": (
        {"displacement_mm"},
        {"cauchy_stress_MPa", "von_mises_MPa", "pressure_MPa", "max_stretch", "region"},
    ),
    "film": ({"displacement_mm"}, {"film_strain", "film_stress_MPa", "charge_density_pC_per_mm2"}),
    "contact": ({"displacement_mm", "gap_mm", "contact_pressure_MPa"}, set()),
    "dot": (set(), set()),
}


def same(found, expected, tolerance=1e-6):
    assert len(found) == len(expected), found
    assert all(abs(a - b) < tolerance for a, b in zip(found, expected, strict=True)), (found, expected)


readers = {}
for name, (points, cells) in ARRAYS.items():
    reader = readers[name] = PVDReader(FileName=f"{folder}/{name}.pvd")
    reader.UpdatePipeline(depth)
    same(list(reader.TimestepValues), [depth * k / steps for k in range(steps + 1)])
    assert points <= set(reader.PointData.keys()), reader.PointData.keys()
    assert cells <= set(reader.CellData.keys()), reader.CellData.keys()

# the tip of the dot is at the pressed depth, and the skin is not above it there
same([readers["dot"].GetDataInformation().GetBounds()[4]], [TOP_MM - depth])
low, _ = readers["contact"].PointData["displacement_mm"].GetRange(2)
assert -1.02 * depth < low < -0.95 * depth, low
same(readers["segment"].GetDataInformation().GetBounds()[4:], (0.0, TOP_MM))

warped = WarpByVector(Input=readers["segment"], Vectors=["POINTS", "displacement_mm"], ScaleFactor=1.0)
cut = Clip(Input=warped)
cut.ClipType = "Plane"
cut.ClipType.Origin, cut.ClipType.Normal = [0, 0.001, 0], [0, -1, 0]
view = GetActiveViewOrCreate("RenderView")
view.ViewSize = [900, 700]
shown = Show(cut, view)
ColorBy(shown, ("CELLS", "max_stretch"))
shown.SetScalarBarVisibility(view, True)
Show(readers["dot"], view)
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
GetAnimationScene().AnimationTime = depth
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [5, -9, 5], [0, 0, 2], [0, 0, 1]
Render(view)
shown.RescaleTransferFunctionToDataRange(False)
Render(view)
SaveScreenshot(picture, view)
print("all as expected")
