<physicalModel name="bodies that are not sound">
<atoms><structuralComponent name="atoms">
<atom><atomProperties index="0" x="0" y="0" z="0"/></atom>
<atom><atomProperties index="1" x="1" y="0" z="0"/></atom>
<atom><atomProperties index="2" x="0" y="1" z="0"/></atom>
<atom><atomProperties index="3" x="0.3" y="0.3" z="0.001"/></atom>
<atom><atomProperties index="4" x="0" y="0" z="1"/></atom>
<atom><atomProperties index="5" x="5" y="0" z="0"/></atom>
<atom><atomProperties index="6" x="6" y="0" z="0"/></atom>
<atom><atomProperties index="7" x="5" y="1" z="0"/></atom>
<atom><atomProperties index="8" x="5" y="0" z="1"/></atom>
</structuralComponent></atoms>
<exclusiveComponents><multiComponent name="all">
<structuralComponent name="flat">
<cell><cellProperties type="TETRAHEDRON" index="0"/><atomRef index="0"/><atomRef index="1"/><atomRef index="2"/><atomRef index="3"/></cell>
</structuralComponent>
<structuralComponent name="two pieces">
<cell><cellProperties type="TETRAHEDRON" index="1"/><atomRef index="0"/><atomRef index="1"/><atomRef index="2"/><atomRef index="4"/></cell>
<cell><cellProperties type="TETRAHEDRON" index="2"/><atomRef index="5"/><atomRef index="6"/><atomRef index="7"/><atomRef index="8"/></cell>
</structuralComponent>
<structuralComponent name="border">
<cell><cellProperties type="TRIANGLE" index="3"/><atomRef index="0"/><atomRef index="1"/><atomRef index="2"/></cell>
</structuralComponent>
</multiComponent></exclusiveComponents>
</physicalModel>
