#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""A window of Qt 5 with a QOpenGLWidget among other widgets: a lit, wavy mesh that turns, in buffers. The toolkit lets
it draw into a framebuffer object, and brings that to the window as a texture. ROWS: of the mesh, of twice as many
columns."""
import math
import os
import sys

import numpy
from OpenGL import GL
from PyQt5.QtCore import QTimer
from PyQt5.QtWidgets import QApplication, QLabel, QOpenGLWidget, QSlider, QVBoxLayout, QWidget

ROWS = int(os.environ.get("ROWS", "300"))
SIZE = (800, 600)


def mesh() -> tuple[numpy.ndarray, numpy.ndarray]:
    """Vertices with their normals, and the indices of triangles."""
    y, x = numpy.mgrid[0:ROWS + 1, 0:2 * ROWS + 1].astype(numpy.float32) / (ROWS / 2)
    x, y = x / 2 - 1, y - 1
    z = 0.1 * numpy.sin(6 * x) * numpy.cos(4 * y)
    normals = (-0.6 * numpy.cos(6 * x) * numpy.cos(4 * y), 0.4 * numpy.sin(6 * x) * numpy.sin(4 * y),
               numpy.ones_like(x))
    vertices = numpy.stack((x, y, z, *normals), axis=-1).astype(numpy.float32)
    first = (numpy.arange(ROWS)[:, None] * (2 * ROWS + 1) + numpy.arange(2 * ROWS)).ravel()
    above = first + 2 * ROWS + 1
    triangles = numpy.stack((first, first + 1, above, first + 1, above + 1, above), axis=-1)
    return vertices, triangles.astype(numpy.uint32)


class Mesh(QOpenGLWidget):
    frame = 0

    def initializeGL(self) -> None:
        vertices, triangles = mesh()
        self.count = triangles.size
        for target, content in ((GL.GL_ARRAY_BUFFER, vertices), (GL.GL_ELEMENT_ARRAY_BUFFER, triangles)):
            GL.glBindBuffer(target, GL.glGenBuffers(1))
            GL.glBufferData(target, content.nbytes, content, GL.GL_STATIC_DRAW)
        self.buffers = [GL.glGetIntegerv(binding)
                        for binding in (GL.GL_ARRAY_BUFFER_BINDING, GL.GL_ELEMENT_ARRAY_BUFFER_BINDING)]

    def paintGL(self) -> None:
        GL.glClearColor(0.1, 0.15, 0.2, 1)
        GL.glClear(GL.GL_COLOR_BUFFER_BIT | GL.GL_DEPTH_BUFFER_BIT)
        for what in (GL.GL_DEPTH_TEST, GL.GL_LIGHTING, GL.GL_LIGHT0, GL.GL_NORMALIZE):
            GL.glEnable(what)
        GL.glLoadIdentity()
        GL.glRotatef(10 * math.sin(0.05 * self.frame), 1, 1, 0)
        GL.glBindBuffer(GL.GL_ARRAY_BUFFER, self.buffers[0])
        GL.glBindBuffer(GL.GL_ELEMENT_ARRAY_BUFFER, self.buffers[1])
        GL.glEnableClientState(GL.GL_VERTEX_ARRAY)
        GL.glEnableClientState(GL.GL_NORMAL_ARRAY)
        GL.glVertexPointer(3, GL.GL_FLOAT, 24, GL.GLvoidp(0))
        GL.glNormalPointer(GL.GL_FLOAT, 24, GL.GLvoidp(12))
        GL.glDrawElements(GL.GL_TRIANGLES, self.count, GL.GL_UNSIGNED_INT, None)
        for what in (GL.GL_DEPTH_TEST, GL.GL_LIGHTING):
            GL.glDisable(what)
        self.frame += 1


app = QApplication(sys.argv)
window = QWidget()
layout = QVBoxLayout(window)
shown = Mesh()
slider = QSlider(1)
layout.addWidget(QLabel("A mesh in a widget"))
layout.addWidget(shown, 1)
layout.addWidget(slider)
window.resize(*SIZE)
window.show()
timer = QTimer()
timer.timeout.connect(shown.update)
timer.start(0)
app.exec()
