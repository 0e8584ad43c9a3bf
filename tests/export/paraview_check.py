"""Run by pvpython: open the collections, check times and arrays, warp and draw."""

import sys

from paraview.simple import (
    Clip,
    ColorBy,
    GetActiveViewOrCreate,
    GetAnimationScene,
    Hide,
    PVDReader,
    Render,
    SaveScreenshot,
    Show,
    WarpByVector,
)

folder, picture = sys.argv[1:3]
ARRAYS = {
    "segment": (
        {"displacement_mm"},
        {"cauchy_stress_MPa", "von_mises_MPa", "pressure_MPa", "max_stretch", "region"},
    ),
    "film": ({"displacement_mm"}, {"film_strain", "film_stress_MPa", "charge_density_pC_per_mm2"}),
    "contact": ({"displacement_mm", "gap_mm", "contact_pressure_MPa"}, set()),
    "dot": (set(), set()),
}
readers = {}
for name, (points, cells) in ARRAYS.items():
    reader = readers[name] = PVDReader(FileName=f"{folder}/{name}.pvd")
    reader.UpdatePipeline(0.3)
    times = [round(t, 9) for t in reader.TimestepValues]
    assert times == [0.0, 0.1, 0.2, 0.3], times
    assert points <= set(reader.PointData.keys()), reader.PointData.keys()
    assert cells <= set(reader.CellData.keys()), reader.CellData.keys()

warped = WarpByVector(Input=readers["segment"], Vectors=["POINTS", "displacement_mm"], ScaleFactor=1.0)
warped.UpdatePipeline(0.3)
low, high = readers["segment"].PointData["displacement_mm"].GetRange(2)
assert abs(low + 0.3) < 1e-9, low
view = GetActiveViewOrCreate("RenderView")
view.ViewSize = [900, 700]
cut = Clip(Input=warped)
cut.ClipType = "Plane"
cut.ClipType.Origin = [0, 0.001, 0]
cut.ClipType.Normal = [0, -1, 0]
shown = Show(cut, view)
ColorBy(shown, ("CELLS", "max_stretch"))
shown.SetScalarBarVisibility(view, True)
Show(readers["dot"], view)
GetAnimationScene().UpdateAnimationUsingDataTimeSteps()
GetAnimationScene().AnimationTime = 0.3
view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [5, -9, 5], [0, 0, 2], [0, 0, 1]
Hide(warped, view)
cut.UpdatePipeline(0.3)
Render(view)
shown.RescaleTransferFunctionToDataRange(False)
Render(view)
SaveScreenshot(picture, view)
print("opened", len(readers))
