// SPDX-License-Identifier: MIT
// A window of Qt Quick that never rests: items that turn and fade, text, a clipped row, and layers with an opacity.
import QtQuick 2.15
import QtQuick.Window 2.15

Window {
    width: 800
    height: 600
    visible: true
    title: "Quick"
    color: "#203040"

    Repeater {
        model: 60
        Rectangle {
            x: 20 + (index % 10) * 78
            y: 20 + Math.floor(index / 10) * 95
            width: 60
            height: 70
            radius: index % 4 * 8
            antialiasing: true
            color: Qt.hsla(index / 60, 0.7, 0.5, 1)
            border.width: index % 3
            NumberAnimation on rotation { from: 0; to: 360; duration: 2000 + index * 50; loops: Animation.Infinite }
            Text { anchors.centerIn: parent; text: index; font.pixelSize: 24; color: "white" }
        }
    }
    Item {
        x: 200; y: 150; width: 400; height: 300
        clip: true
        layer.enabled: true
        SequentialAnimation on opacity {
            loops: Animation.Infinite
            NumberAnimation { from: 0.2; to: 0.9; duration: 1500 }
            NumberAnimation { from: 0.9; to: 0.2; duration: 1500 }
        }
        Rectangle {
            width: 500; height: 200; y: 50
            gradient: Gradient {
                GradientStop { position: 0; color: "steelblue" }
                GradientStop { position: 1; color: "darkorange" }
            }
            NumberAnimation on x { from: -300; to: 200; duration: 3000; loops: Animation.Infinite }
        }
    }
}
