# SPDX-License-Identifier: MIT
"""For ParaView: contours of a volume, in a frame of lines, while the camera goes around. CELLS: how far the volume
goes to each side."""
import os

from paraview.simple import (CameraKeyFrame, ColorBy, Contour, GetActiveViewOrCreate, GetAnimationScene, GetCameraTrack,
                             Hide, Outline, Show, Wavelet)

view = GetActiveViewOrCreate("RenderView")
cells = int(os.environ.get("CELLS", "20"))
volume = Wavelet(WholeExtent=[-cells, cells] * 3)
contour = Contour(Input=volume, ContourBy=["POINTS", "RTData"], Isosurfaces=[100, 150, 200])
shown = Show(contour, view)
ColorBy(shown, ("POINTS", "RTData"))
shown.SetScalarBarVisibility(view, True)
Show(Outline(Input=volume), view)
Hide(volume, view)
view.ResetCamera()
scene = GetAnimationScene()
track = GetCameraTrack(view=view)
track.Mode = "Path-based"
start, end = CameraKeyFrame(), CameraKeyFrame()
start.KeyTime, end.KeyTime = 0.0, 1.0
start.PositionPathPoints = [90, 0, 30, 0, 90, 30, -90, 0, 30, 0, -90, 30]
start.FocalPathPoints = [0, 0, 0]
start.PositionMode = "Path"
start.ClosedPositionPath = 1
start.ViewUp = [0, 0, 1]
track.KeyFrames = [start, end]
scene.PlayMode = "Sequence"
scene.NumberOfFrames = 200
scene.Loop = 1
scene.Play()
