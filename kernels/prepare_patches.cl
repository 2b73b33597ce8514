// Sec. 1.5.1 and 1.5.2 in one launch, and the first half of the sort by tiles: each PE goes on with
// what it alone has found, so nothing is gained by waiting for the others in between.
// Compiled behind the three kernels that it calls.

__kernel void prepare_patches(const __global Shot* salvo, const __global Cluster* clusters,
                              const __global int* corners, const __global float* normals,
                              const __global int* planes, const __global int* rooms, int stride,
                              int depth, __global Level* stack, __global int* stack_height,
                              __global Projection* projections, __global Rectangle* rectangles,
                              __global int* projection_count, __global int* tile_counts) {
    cull_patches(salvo, clusters, corners, normals, planes, rooms, stride, depth, stack,
                 stack_height);
    set_up_projection(salvo, corners, normals, stride, depth, stack, stack_height, projections,
                      rectangles, projection_count);
    count_areas(salvo, rectangles, projection_count, depth, tile_counts);
}
