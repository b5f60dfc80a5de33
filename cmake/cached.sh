#!/bin/sh
# SPDX-License-Identifier: MIT
# cached.sh SOURCES COMPILER ARGUMENTS...: compiles with ccache, set so that clones in other folders find each other's
# results, precompiled headers included.
export CCACHE_BASEDIR="$1" CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros
shift

# A precompiled header that is made anew: while the old one lies there, GCC's preprocessor takes that for the header,
# and ccache would find a result that was once made after the same old one, whatever the header says by now. Comments
# count: a result of other comments is of another file to GCC, which would then take in the same header twice.
case " $* " in
*" c++-header "*)
  export CCACHE_COMMENTS=1
  previous=
  for argument in "$@"; do
    [ "$previous" != -o ] || rm -f "$argument"
    previous=$argument
  done ;;
esac
exec ccache "$@"
