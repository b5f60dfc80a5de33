// SPDX-License-Identifier: MIT
// What OpenGL answers: every query of 1.1 after scripted calls, errors, attribute stacks, matrices, feedback,
// selection.
#include <cmath>
#include <cstring>

#include "tests/golden/programs/scene.h"

namespace golden {
namespace {

struct Query {
    GLenum name;
    const char* text;
    int values;
};
#define Q(NAME, VALUES) \
    { GL_##NAME, #NAME, VALUES }

const Query kQueries[] = {
    Q(ACCUM_ALPHA_BITS, 1),
    Q(ACCUM_CLEAR_VALUE, 4),
    Q(ALPHA_BIAS, 1),
    Q(ALPHA_SCALE, 1),
    Q(ALPHA_TEST, 1),
    Q(ALPHA_TEST_FUNC, 1),
    Q(ALPHA_TEST_REF, 1),
    Q(ATTRIB_STACK_DEPTH, 1),
    Q(AUTO_NORMAL, 1),
    Q(AUX_BUFFERS, 1),
    Q(BLEND, 1),
    Q(BLEND_DST, 1),
    Q(BLEND_SRC, 1),
    Q(BLUE_BIAS, 1),
    Q(BLUE_SCALE, 1),
    Q(CLIENT_ATTRIB_STACK_DEPTH, 1),
    Q(CLIP_PLANE0, 1),
    Q(CLIP_PLANE5, 1),
    Q(COLOR_ARRAY, 1),
    Q(COLOR_ARRAY_SIZE, 1),
    Q(COLOR_ARRAY_STRIDE, 1),
    Q(COLOR_ARRAY_TYPE, 1),
    Q(COLOR_CLEAR_VALUE, 4),
    Q(COLOR_LOGIC_OP, 1),
    Q(COLOR_MATERIAL, 1),
    Q(COLOR_MATERIAL_FACE, 1),
    Q(COLOR_MATERIAL_PARAMETER, 1),
    Q(COLOR_WRITEMASK, 4),
    Q(CULL_FACE, 1),
    Q(CULL_FACE_MODE, 1),
    Q(CURRENT_COLOR, 4),
    Q(CURRENT_NORMAL, 3),
    Q(CURRENT_RASTER_COLOR, 4),
    Q(CURRENT_RASTER_DISTANCE, 1),
    Q(CURRENT_RASTER_POSITION, 4),
    Q(CURRENT_RASTER_POSITION_VALID, 1),
    Q(CURRENT_RASTER_TEXTURE_COORDS, 4),
    Q(CURRENT_TEXTURE_COORDS, 4),
    Q(DEPTH_BIAS, 1),
    Q(DEPTH_BITS, 1),
    Q(DEPTH_CLEAR_VALUE, 1),
    Q(DEPTH_FUNC, 1),
    Q(DEPTH_RANGE, 2),
    Q(DEPTH_SCALE, 1),
    Q(DEPTH_TEST, 1),
    Q(DEPTH_WRITEMASK, 1),
    Q(DITHER, 1),
    Q(DOUBLEBUFFER, 1),
    Q(DRAW_BUFFER, 1),
    Q(EDGE_FLAG, 1),
    Q(EDGE_FLAG_ARRAY, 1),
    Q(EDGE_FLAG_ARRAY_STRIDE, 1),
    Q(FEEDBACK_BUFFER_SIZE, 1),
    Q(FEEDBACK_BUFFER_TYPE, 1),
    Q(FOG, 1),
    Q(FOG_COLOR, 4),
    Q(FOG_DENSITY, 1),
    Q(FOG_END, 1),
    Q(FOG_HINT, 1),
    Q(FOG_MODE, 1),
    Q(FOG_START, 1),
    Q(FRONT_FACE, 1),
    Q(GREEN_BIAS, 1),
    Q(GREEN_BITS, 1),
    Q(GREEN_SCALE, 1),
    Q(INDEX_OFFSET, 1),
    Q(INDEX_SHIFT, 1),
    Q(LIGHT0, 1),
    Q(LIGHT7, 1),
    Q(LIGHTING, 1),
    Q(LIGHT_MODEL_AMBIENT, 4),
    Q(LIGHT_MODEL_LOCAL_VIEWER, 1),
    Q(LIGHT_MODEL_TWO_SIDE, 1),
    Q(LINE_SMOOTH, 1),
    Q(LINE_SMOOTH_HINT, 1),
    Q(LINE_STIPPLE, 1),
    Q(LINE_STIPPLE_PATTERN, 1),
    Q(LINE_STIPPLE_REPEAT, 1),
    Q(LINE_WIDTH, 1),
    Q(LIST_BASE, 1),
    Q(LIST_INDEX, 1),
    Q(LIST_MODE, 1),
    Q(LOGIC_OP_MODE, 1),
    Q(MAP1_COLOR_4, 1),
    Q(MAP1_GRID_DOMAIN, 2),
    Q(MAP1_GRID_SEGMENTS, 1),
    Q(MAP2_GRID_DOMAIN, 4),
    Q(MAP2_GRID_SEGMENTS, 2),
    Q(MAP2_VERTEX_3, 1),
    Q(MAP_COLOR, 1),
    Q(MAP_STENCIL, 1),
    Q(MATRIX_MODE, 1),
    Q(MAX_CLIP_PLANES, 1),
    Q(MAX_EVAL_ORDER, 1),
    Q(MAX_LIGHTS, 1),
    Q(MAX_ATTRIB_STACK_DEPTH, 1),
    Q(MAX_CLIENT_ATTRIB_STACK_DEPTH, 1),
    Q(MAX_MODELVIEW_STACK_DEPTH, 1),
    Q(MAX_NAME_STACK_DEPTH, 1),
    Q(MAX_PIXEL_MAP_TABLE, 1),
    Q(MAX_PROJECTION_STACK_DEPTH, 1),
    Q(MAX_TEXTURE_STACK_DEPTH, 1),
    Q(MAX_LIST_NESTING, 1),
    Q(MODELVIEW_MATRIX, 16),
    Q(MODELVIEW_STACK_DEPTH, 1),
    Q(NAME_STACK_DEPTH, 1),
    Q(NORMALIZE, 1),
    Q(NORMAL_ARRAY, 1),
    Q(NORMAL_ARRAY_STRIDE, 1),
    Q(NORMAL_ARRAY_TYPE, 1),
    Q(PACK_ALIGNMENT, 1),
    Q(PACK_LSB_FIRST, 1),
    Q(PACK_ROW_LENGTH, 1),
    Q(PACK_SKIP_PIXELS, 1),
    Q(PACK_SKIP_ROWS, 1),
    Q(PACK_SWAP_BYTES, 1),
    Q(PERSPECTIVE_CORRECTION_HINT, 1),
    Q(PIXEL_MAP_A_TO_A_SIZE, 1),
    Q(PIXEL_MAP_I_TO_I_SIZE, 1),
    Q(PIXEL_MAP_I_TO_R_SIZE, 1),
    Q(POINT_SIZE, 1),
    Q(POINT_SMOOTH, 1),
    Q(POINT_SMOOTH_HINT, 1),
    Q(POLYGON_MODE, 2),
    Q(POLYGON_OFFSET_FACTOR, 1),
    Q(POLYGON_OFFSET_FILL, 1),
    Q(POLYGON_OFFSET_LINE, 1),
    Q(POLYGON_OFFSET_POINT, 1),
    Q(POLYGON_OFFSET_UNITS, 1),
    Q(POLYGON_SMOOTH, 1),
    Q(POLYGON_SMOOTH_HINT, 1),
    Q(POLYGON_STIPPLE, 1),
    Q(PROJECTION_MATRIX, 16),
    Q(PROJECTION_STACK_DEPTH, 1),
    Q(READ_BUFFER, 1),
    Q(RED_BIAS, 1),
    Q(RED_BITS, 1),
    Q(RED_SCALE, 1),
    Q(RENDER_MODE, 1),
    Q(RGBA_MODE, 1),
    Q(SCISSOR_BOX, 4),
    Q(SCISSOR_TEST, 1),
    Q(SELECTION_BUFFER_SIZE, 1),
    Q(SHADE_MODEL, 1),
    Q(STENCIL_BITS, 1),
    Q(STENCIL_CLEAR_VALUE, 1),
    Q(STENCIL_FAIL, 1),
    Q(STENCIL_FUNC, 1),
    Q(STENCIL_PASS_DEPTH_FAIL, 1),
    Q(STENCIL_PASS_DEPTH_PASS, 1),
    Q(STENCIL_REF, 1),
    Q(STENCIL_TEST, 1),
    Q(STENCIL_VALUE_MASK, 1),
    Q(STENCIL_WRITEMASK, 1),
    Q(STEREO, 1),
    Q(SUBPIXEL_BITS, 1),
    Q(TEXTURE_1D, 1),
    Q(TEXTURE_2D, 1),
    Q(TEXTURE_BINDING_1D, 1),
    Q(TEXTURE_BINDING_2D, 1),
    Q(TEXTURE_COORD_ARRAY, 1),
    Q(TEXTURE_COORD_ARRAY_SIZE, 1),
    Q(TEXTURE_COORD_ARRAY_STRIDE, 1),
    Q(TEXTURE_COORD_ARRAY_TYPE, 1),
    Q(TEXTURE_GEN_Q, 1),
    Q(TEXTURE_GEN_S, 1),
    Q(TEXTURE_MATRIX, 16),
    Q(TEXTURE_STACK_DEPTH, 1),
    Q(UNPACK_ALIGNMENT, 1),
    Q(UNPACK_LSB_FIRST, 1),
    Q(UNPACK_ROW_LENGTH, 1),
    Q(UNPACK_SKIP_PIXELS, 1),
    Q(UNPACK_SKIP_ROWS, 1),
    Q(UNPACK_SWAP_BYTES, 1),
    Q(VERTEX_ARRAY, 1),
    Q(VERTEX_ARRAY_SIZE, 1),
    Q(VERTEX_ARRAY_STRIDE, 1),
    Q(VERTEX_ARRAY_TYPE, 1),
    Q(VIEWPORT, 4),
    Q(ZOOM_X, 1),
    Q(ZOOM_Y, 1),
};
#undef Q

void say_values(const char* kind, const char* name, const GLdouble* values, int count) {
    char line[512];
    int at = 0;
    for (int i = 0; i < count; ++i)
        at += std::snprintf(line + at, sizeof line - static_cast<std::size_t>(at), " %.6g", values[i]);
    say("%s %s%s", kind, name, line);
}

/// Each question in all four types: conversions are part of the answer.
void ask_everything() {
    for (const Query& query : kQueries) {
        GLdouble doubles[16] = {}, copy[16] = {};
        GLfloat floats[16] = {};
        GLint ints[16] = {};
        GLboolean booleans[16] = {};
        glGetDoublev(query.name, doubles);
        say_values("d", query.text, doubles, query.values);
        glGetFloatv(query.name, floats);
        for (int i = 0; i < query.values; ++i) copy[i] = floats[i];
        say_values("f", query.text, copy, query.values);
        if (query.values == 16) continue;  // Mesa's integers of matrices overflow
        glGetIntegerv(query.name, ints);
        for (int i = 0; i < query.values; ++i) copy[i] = ints[i];
        say_values("i", query.text, copy, query.values);
        glGetBooleanv(query.name, booleans);
        for (int i = 0; i < query.values; ++i) copy[i] = booleans[i];
        say_values("b", query.text, copy, query.values);
        say_error(query.text);
    }
}

void ask_objects() {
    GLfloat answer[4] = {};
    GLint whole[4] = {};
    for (GLenum i = 0; i < 8; i += 3)
        for (const GLenum name :
             {GL_AMBIENT, GL_DIFFUSE, GL_SPECULAR, GL_POSITION, GL_SPOT_DIRECTION, GL_SPOT_EXPONENT, GL_SPOT_CUTOFF,
              GL_CONSTANT_ATTENUATION, GL_LINEAR_ATTENUATION, GL_QUADRATIC_ATTENUATION}) {
            std::memset(answer, 0, sizeof answer);
            glGetLightfv(GL_LIGHT0 + i, name, answer);
            glGetLightiv(GL_LIGHT0 + i, name, whole);
            say("light %u %04x: %.5g %.5g %.5g %.5g i %d %d", i, name, answer[0], answer[1], answer[2], answer[3],
                whole[0], whole[1]);
        }
    for (const GLenum coordinate : {GL_S, GL_T, GL_R, GL_Q})
        for (const GLenum name : {GL_TEXTURE_GEN_MODE, GL_OBJECT_PLANE, GL_EYE_PLANE}) {
            std::memset(answer, 0, sizeof answer);
            glGetTexGenfv(coordinate, name, answer);
            say("texgen %04x %04x: %.5g %.5g %.5g %.5g", coordinate, name, answer[0], answer[1], answer[2], answer[3]);
        }
    for (const GLenum target : {GL_TEXTURE_1D, GL_TEXTURE_2D})
        for (const GLenum name : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER, GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T,
                                  GL_TEXTURE_BORDER_COLOR, GL_TEXTURE_PRIORITY}) {
            std::memset(answer, 0, sizeof answer);
            glGetTexParameterfv(target, name, answer);
            say("texture %04x %04x: %.5g %.5g %.5g %.5g", target, name, answer[0], answer[1], answer[2], answer[3]);
        }
    glGetTexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, answer);
    glGetTexEnviv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, whole);
    say("environment %x %.5g %.5g", static_cast<unsigned>(whole[0]), answer[0], answer[3]);
    say_error("objects");
}

void change_many_things() {
    glMatrixMode(GL_PROJECTION);
    glFrustum(-1, 2, -1.5, 1, 0.5, 40);
    glMatrixMode(GL_TEXTURE);
    glScalef(2, 3, 4);
    glPushMatrix();
    glMatrixMode(GL_MODELVIEW);
    glRotated(33, 1, 2, 3);
    glPushMatrix();
    glTranslated(1, 2, 3);
    glColor4ub(10, 200, 255, 77);
    glNormal3b(127, -128, 5);
    glTexCoord3s(1, -2, 3);
    glEdgeFlag(GL_FALSE);
    glRasterPos3f(0.1f, 0.2f, -3);
    glClearColor(1.5f, -0.5f, 0.3f, 0.7f);
    glClearAccum(-0.5f, 0.5f, 1, 0);
    glClearDepth(0.3);
    glClearStencil(300);
    glLineWidth(2.5f);
    glLineStipple(300, 0xabcd);
    glPointSize(3.3f);
    glPolygonMode(GL_BACK, GL_POINT);
    glPolygonOffset(1.5f, -2);
    glShadeModel(GL_FLAT);
    glCullFace(GL_FRONT_AND_BACK);
    glFrontFace(GL_CW);
    glEnable(GL_POLYGON_OFFSET_LINE);
    glEnable(GL_LIGHT7);
    glEnable(GL_CLIP_PLANE5);
    glEnable(GL_NORMALIZE);
    const GLfloat position[] = {1, 2, 3, 0}, spot[] = {0, -1, 1};
    glLightfv(GL_LIGHT3, GL_POSITION, position);
    glLightfv(GL_LIGHT3, GL_SPOT_DIRECTION, spot);
    glLighti(GL_LIGHT6, GL_SPOT_CUTOFF, 45);
    const GLint ambient[] = {2147483647, 0, -2147483647, 1 << 30};
    glLightiv(GL_LIGHT3, GL_AMBIENT, ambient);
    glLightModelf(GL_LIGHT_MODEL_TWO_SIDE, 1);
    glColorMaterial(GL_BACK, GL_EMISSION);
    glFogf(GL_FOG_MODE, GL_EXP2);
    glFogf(GL_FOG_DENSITY, 0.77f);
    glDepthFunc(GL_GEQUAL);
    glDepthRange(0.75, 0.25);
    glDepthMask(0);
    glStencilFunc(GL_NOTEQUAL, 5, 0xf0);
    glStencilOp(GL_INCR, GL_DECR, GL_INVERT);
    glStencilMask(0x55);
    glBlendFunc(GL_DST_COLOR, GL_ONE_MINUS_SRC_ALPHA);
    glAlphaFunc(GL_LESS, 0.25f);
    glLogicOp(GL_NOR);
    glColorMask(1, 0, 0, 1);
    glScissor(3, 4, 50, 60);
    glViewport(5, 6, 222, 111);
    glPixelZoom(2, -0.5f);
    glPixelTransferf(GL_RED_BIAS, 0.25f);
    glPixelTransferi(GL_INDEX_SHIFT, 3);
    glPixelStorei(GL_PACK_ROW_LENGTH, 17);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
    glPixelStoref(GL_UNPACK_SWAP_BYTES, 1);
    glMapGrid1f(7, -1, 4);
    glMapGrid2d(3, 0, 1, 4, 2, 5);
    glListBase(1234);
    glHint(GL_FOG_HINT, GL_NICEST);
    const GLfloat plane[] = {1, 2, 3, 4};
    glTexGenfv(GL_R, GL_EYE_PLANE, plane);
    glTexGenfv(GL_Q, GL_OBJECT_PLANE, plane);
    glTexGeni(GL_T, GL_TEXTURE_GEN_MODE, GL_SPHERE_MAP);
    glBindTexture(GL_TEXTURE_2D, 5);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_PRIORITY, 0.4f);
    glTexEnvf(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_BLEND);
    glEnable(GL_TEXTURE_GEN_Q);
    glPushAttrib(GL_FOG_BIT);
    glPushClientAttrib(GL_CLIENT_VERTEX_ARRAY_BIT);
    glInterleavedArrays(GL_T2F_C4UB_V3F, 40, plane);
}

void restore() {
    glPopClientAttrib();
    glPopAttrib();
    glViewport(0, 0, 400, 300);
}

void tilted_triangle() {
    glBegin(GL_TRIANGLES);
    glColor3f(1, 0, 0);
    glTexCoord2f(0, 0.5f);
    glVertex3f(-0.5f, -0.5f, 0);
    glColor3f(0, 1, 0);
    glVertex3f(1.5f, -0.5f, 0.2f);  // clipped
    glColor3f(0, 0, 1);
    glVertex3f(0, 0.9f, -0.2f);
    glEnd();
}

}  // namespace

SCENE(queries, 2) {
    clear(0, 0.3f, 0);
    if (frame == 1) change_many_things();
    ask_everything();
    ask_objects();
    if (frame == 1) restore();
}

SCENE(errors, 1) {
    clear(0.3f, 0, 0);
    say_error("nothing yet");
    glEnable(0x1234);
    say_error("enable");
    glBegin(0x77);
    say_error("begin mode");
    glBegin(GL_TRIANGLES);
    glBegin(GL_LINES);
    glEnable(GL_BLEND);
    glClear(GL_COLOR_BUFFER_BIT);
    glMatrixMode(GL_PROJECTION);
    glEnd();
    say_error("inside begin");
    say_error("only once");
    glEnd();
    say_error("end alone");
    glLineWidth(-1);
    say_error("line width");
    glPointSize(0);
    say_error("point size");
    glViewport(0, 0, -1, 5);
    say_error("viewport");
    glScissor(0, 0, 4, -4);
    say_error("scissor");
    glPopMatrix();
    say_error("pop matrix");
    for (int i = 0; i < 40; ++i) glPushMatrix();
    say_error("push matrix");
    while (glGetError() == GL_NO_ERROR) glPopMatrix();
    for (int i = 0; i < 20; ++i) glPushAttrib(GL_ALL_ATTRIB_BITS);
    say_error("push attributes");
    for (int i = 0; i < 20; ++i) glPopAttrib();
    say_error("pop attributes");
    for (int i = 0; i < 17; ++i) glPopClientAttrib();
    say_error("pop client attributes");
    glFrustum(-1, 1, -1, 1, 0, 5);
    say_error("frustum");
    glOrtho(1, 1, 0, 1, 0, 1);
    say_error("ortho");
    glFogf(GL_FOG_DENSITY, -1);
    say_error("fog");
    glLightf(GL_LIGHT0, GL_SPOT_CUTOFF, 95);
    say_error("cutoff");
    glMaterialf(GL_FRONT, GL_SHININESS, 129);
    say_error("shininess");
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_MODULATE);
    say_error("filter");
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 16, 16, 3, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    say_error("border");
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, -1, 16, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    say_error("negative size");
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 16, 16, 0, GL_RGBA, GL_BITMAP, nullptr);
    say_error("type");
    glTexSubImage2D(GL_TEXTURE_2D, 3, 0, 0, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE, kQueries);
    say_error("sub-image of nothing");
    glBindTexture(GL_TEXTURE_1D, 50);
    glBindTexture(GL_TEXTURE_2D, 50);
    say_error("other target");
    glDrawArrays(GL_TRIANGLES, 0, -1);
    say_error("negative count");
    glDrawElements(GL_TRIANGLES, 3, GL_FLOAT, nullptr);
    say_error("index type");
    glVertexPointer(5, GL_FLOAT, 0, nullptr);
    say_error("array size");
    glColorPointer(3, GL_FLOAT, -1, nullptr);
    say_error("stride");
    glPixelStorei(GL_UNPACK_ALIGNMENT, 3);
    say_error("alignment");
    glPixelZoom(1, 1);
    glDrawPixels(-1, 1, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    say_error("draw pixels");
    glReadPixels(0, 0, 1, 1, GL_RGBA, 0x99, nullptr);
    say_error("read pixels");
    glMap1f(GL_MAP1_VERTEX_3, 0, 0, 3, 2, nullptr);
    say_error("map domain");
    glMap1f(GL_MAP1_VERTEX_3, 0, 1, 2, 2, nullptr);
    say_error("map stride");
    glEvalMesh1(GL_FILL, 0, 1);
    say_error("mesh mode");
    glCallLists(1, GL_RGBA, nullptr);
    say_error("list type");
    glDeleteLists(1, -1);
    say_error("list range");
    glRenderMode(GL_FEEDBACK);
    say_error("no feedback buffer");
    glPushName(1);
    say_error("names are ignored while rendering");
    GLint value = 99;
    glGetIntegerv(0x4321, &value);
    say_error("get");
    say("untouched %d", value);
    glClear(1 << 30);
    say_error("clear");
    glStencilFunc(GL_ONE, 0, 0);
    say_error("stencil");
    glBlendFunc(GL_LESS, GL_ONE);
    say_error("blend");
    glHint(GL_FOG_HINT, GL_LESS);
    say_error("hint");
    glDrawBuffer(GL_FOG);
    say_error("draw buffer");
}

SCENE(attribute_stacks, 8) {
    const GLbitfield bits[] = {GL_CURRENT_BIT | GL_POINT_BIT,
                               GL_LIGHTING_BIT,
                               GL_ENABLE_BIT,
                               GL_TEXTURE_BIT,
                               GL_TRANSFORM_BIT | GL_VIEWPORT_BIT,
                               GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT,
                               GL_POLYGON_BIT | GL_LINE_BIT | GL_FOG_BIT | GL_HINT_BIT,
                               GL_ALL_ATTRIB_BITS};
    clear(0, 0, 0.4f);
    // What `bits` do not cover stays changed, also in later frames. Mesa 22 forgets what changed under an inner mask
    // when an outer, wider one is popped, so only equal masks are nested here.
    glPushAttrib(bits[frame]);
    glLineWidth(4);
    if (frame == 7) glPushAttrib(bits[frame]);
    change_many_things();
    restore();
    if (frame == 7) glPopAttrib();
    glPopAttrib();
    ask_everything();
    ask_objects();
    glMatrixMode(GL_TEXTURE);
    glPopMatrix();
    glLoadIdentity();
    glMatrixMode(GL_MODELVIEW);
    glPopMatrix();
    cell_view(0, 1, 1);
    glViewport(0, 0, canvas.width, canvas.height);
    glColorMask(1, 1, 1, 1);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glDisable(GL_CLIP_PLANE5);
    tilted_triangle();
}

SCENE(matrices, 2) {
    clear();
    perspective_view(canvas);
    const GLfloat shear[] = {1, 0.3f, 0, 0, 0.2f, 1, 0, 0, 0, 0, 1, 0, 0.1f, 0.2f, 0, 1};
    const GLdouble squeeze[] = {0.7, 0, 0, 0, 0, 0.9, 0, 0, 0, 0, 1, 0, 0, 0, 0.2, 1};
    for (int i = 0; i < 30; ++i) {
        if (i % 5 == 4) glPopMatrix();
        else glPushMatrix();
        if (i % 3 == 0) glMultMatrixf(shear);
        if (i % 3 == 1) glMultMatrixd(squeeze);
        glRotatef(static_cast<float>(i) * 17.3f, random_unit(), random_unit(), random_unit() + 0.1f);
        glRotatef(90, 0, 0, 1);
        glScaled(0.9, 1.1, 1);
        glTranslatef(0.2f, -0.1f, 0.05f);
        glColor3f(random_unit(), random_unit(), random_unit());
        unit_square();
        GLfloat now[16];  // every bit: what lies on the same plane must stay there
        glGetFloatv(GL_MODELVIEW_MATRIX, now);
        for (int k = 0; k < 16; k += 4) say("modelview %a %a %a %a", now[k], now[k + 1], now[k + 2], now[k + 3]);
    }
    GLint depth = 0;
    glGetIntegerv(GL_MODELVIEW_STACK_DEPTH, &depth);
    say("depth %d", depth);
    for (; depth > 1; --depth) glPopMatrix();
    glMatrixMode(GL_PROJECTION);
    glLoadMatrixf(shear);
    glOrtho(-3, 2, -1, 4, -5, 7);
    GLfloat projection[16];
    glGetFloatv(GL_PROJECTION_MATRIX, projection);
    say("projection %a %a %a %a", projection[0], projection[5], projection[10], projection[14]);
    glMatrixMode(GL_MODELVIEW);
    unit_square();
}

SCENE(current_values, 2) {  // after End, arrays and lists
    clear();
    cell_view(0, 1, 1);
    tilted_triangle();
    GLfloat colour[4], coordinate[4], normal[3];
    const auto ask = [&](const char* when) {
        glGetFloatv(GL_CURRENT_COLOR, colour);
        glGetFloatv(GL_CURRENT_TEXTURE_COORDS, coordinate);
        glGetFloatv(GL_CURRENT_NORMAL, normal);
        say("%s: %.6g %.6g %.6g %.6g, %.6g %.6g %.6g %.6g, %.6g %.6g %.6g", when, colour[0], colour[1], colour[2],
            colour[3], coordinate[0], coordinate[1], coordinate[2], coordinate[3], normal[0], normal[1], normal[2]);
    };
    ask("after End");
    glColor3b(-5, 100, 127);
    glNormal3i(2147483647, -1, 5);
    glTexCoord1d(7);
    ask("by calls");
    glColor4us(1, 2, 3, 65535);
    glNormal3s(-32768, 32767, 0);
    glTexCoord4i(1, 2, 3, 4);
    ask("by others");
    const GLuint bright[] = {0xffffffff, 0x80000000, 0x1};
    glColor3uiv(bright);
    ask("unsigned");
    glBegin(GL_POINTS);
    for (int i = 0; i < 3000; ++i) {
        glColor3f(static_cast<float>(i) / 3000, 0, 1);
        glNormal3f(0, 1, static_cast<float>(i));
        glVertex2f(static_cast<float>(i) / 1500 - 1, static_cast<float>(i % 50) / 25 - 1);
    }
    glTexCoord2f(9, 8);
    glEnd();
    ask("after many");
}

SCENE(feedback, 2) {
    const GLenum types[] = {GL_2D, GL_3D, GL_3D_COLOR, GL_3D_COLOR_TEXTURE, GL_4D_COLOR_TEXTURE};
    clear();
    for (const GLenum type : types) {
        GLfloat buffer[1024] = {};
        glFeedbackBuffer(frame ? 40 : 1024, type, buffer);
        glRenderMode(GL_FEEDBACK);
        tilted_triangle();
        glPassThrough(42.5f);
        glBegin(GL_LINE_LOOP);
        glVertex2f(-0.3f, 0.1f);
        glVertex2f(0.4f, 0.2f);
        glVertex2f(0.1f, -2);
        glEnd();
        glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
        glRectf(-0.1f, -0.1f, 0.1f, 0.1f);
        glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
        glRasterPos2f(0.25f, 0.25f);
        glBitmap(0, 0, 0, 0, 1, 1, nullptr);
        glDrawPixels(0, 0, GL_RGB, GL_UNSIGNED_BYTE, nullptr);
        const GLint values = glRenderMode(GL_RENDER);
        say("feedback %04x: %d", type, values);
        for (int i = 0; i + 8 <= values; i += 8)
            say("  %.5g %.5g %.5g %.5g %.5g %.5g %.5g %.5g", buffer[i], buffer[i + 1], buffer[i + 2], buffer[i + 3],
                buffer[i + 4], buffer[i + 5], buffer[i + 6], buffer[i + 7]);
    }
    say_error("feedback");
    tilted_triangle();
}

SCENE(selection, 2) {
    clear();
    GLuint buffer[256] = {};
    glSelectBuffer(frame ? 11 : 256, buffer);
    glRenderMode(GL_SELECT);
    glInitNames();
    glPushName(0);
    for (GLuint i = 0; i < 30; ++i) {
        glLoadName(i);
        if (i % 4 == 0) glPushName(100 + i);
        glBegin(i % 3 ? GL_TRIANGLES : GL_LINES);
        // Nothing reaches the far plane: Mesa says 0, not 2^32 - 1, for a farthest depth of 1.
        for (int k = 0; k < 6; ++k)
            glVertex3f(random_unit() * 6 - 3, random_unit() * 6 - 3, random_unit() * 1.8f - 0.9f);
        glEnd();
        if (i % 7 == 0) glRasterPos2f(0.2f, 0.3f);
        if (i % 4 == 0) glPopName();
    }
    const GLint hits = glRenderMode(GL_RENDER);
    say("hits %d", hits);
    const GLuint* at = buffer;
    for (GLint i = 0; i < hits && at + 3 < buffer + 256; ++i) {
        say("  %u names, depth %.6g to %.6g, first %u last %u", at[0], at[1] / 4294967295.0, at[2] / 4294967295.0,
            at[3], at[2 + at[0]]);
        at += 3 + at[0];
    }
    say_error("selection");
    tilted_triangle();
}

}  // namespace golden
